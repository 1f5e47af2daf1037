// How to connect any device to tapstudy: a separate program that answers its datagrams. Copy this,
// and replace the finger below by calls to your device. It needs server.hpp and ../wire.hpp, and
// nothing else of tapstudy.
//
//   bridge PORT    and in the rig   device: remote   remote: {port: PORT}
#include "server.hpp"
namespace {
// A finger of 0.1 kg on a muscle that lets it tap twice a second, pushed by the force; y is up. It
// moves a millisecond with each sample.
class Finger final : public bridge::Device {
 public:
  bridge::wire::Introduction introduction() override {
    bridge::wire::Introduction told;
    told.workspace_radius_m = 0.1;
    told.max_force_n = 5.0;
    told.max_stiffness_n_per_m = 1e6;  // it is computed
    told.rate_hz = 1000.0;
    bridge::put_text(told.name, "example finger");
    bridge::put_text(told.serial_number, "1");
    return told;
  }
  void exert(const bridge::wire::Vector& force_n) override { force_n_ = force_n; }
  void sample(bridge::wire::Reply& reply) override {
    move();
    reply.sample = ++samples_;
    reply.position_m = position_m_;
    reply.velocity_m_s = velocity_m_s_;
    reply.exerted_n = force_n_;
    bridge::put_text(reply.text, "a finger that is computed");  // for the operator
  }

 private:
  void move() {
    constexpr double step_s = 1e-3;
    const double time_s = step_s * static_cast<double>(samples_ + 1);
    const bridge::wire::Vector aim_m{0.0, 0.01 + 0.012 * std::cos(4.0 * M_PI * time_s), 0.0};
    for (std::size_t i = 0; i < 3; ++i) {
      const double pull_n = 400.0 * (aim_m[i] - position_m_[i]) - 9.0 * velocity_m_s_[i];
      velocity_m_s_[i] += step_s * (pull_n + force_n_[i]) / 0.1;
      position_m_[i] += step_s * velocity_m_s_[i];
    }
  }
  bridge::wire::Vector position_m_{0.0, 0.02, 0.0};
  bridge::wire::Vector velocity_m_s_{};
  bridge::wire::Vector force_n_{};
  std::uint64_t samples_ = 0;
};
}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: bridge PORT\n", stderr);
    return 2;
  }
  Finger finger;
  bridge::Server{std::atoi(argv[1]), finger}.run();
}
