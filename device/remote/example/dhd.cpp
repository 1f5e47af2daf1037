// The omega, delta and sigma of Force Dimension and the Falcon of Novint, through the DHD
// interface, as a device of tapstudy. Builds with the vendor's kit:
//
//   c++ -std=c++20 -o dhd dhd.cpp -I KIT/include -L KIT/lib -ldhd -lusb-1.0 -lpthread
//   dhd PORT MAX_FORCE_N MAX_STIFFNESS_N_PER_M WORKSPACE_RADIUS_M
//   and in the rig   device: remote   remote: {port: PORT}
//
// The three limits are in the data sheet of the device. Should this program die or hang, the device
// itself releases the force after 20 ms (dhdSetWatchdog); one that cannot is refused.
#include <dhdc.h>

#include <string>

#include "server.hpp"
namespace {
struct Limits {
  double max_force_n;
  double max_stiffness_n_per_m;
  double workspace_radius_m;
};

[[noreturn]] void give_up(const char* what) {
  std::fprintf(stderr, "dhd: %s: %s\n", what, dhdErrorGetLastStr());
  std::exit(1);
}

class DhdDevice final : public bridge::Device {
 public:
  // Ends the program if there is no device that can be relied on.
  explicit DhdDevice(const Limits& limits) : limits_{limits}, id_{dhdOpen()} {
    constexpr unsigned char watchdog_of_20_ms = 160;  // in units of 125 us
    if (id_ < 0) {
      give_up("no device can be opened");
    }
    dhdEnableExpertMode();
    if (dhdSetWatchdog(watchdog_of_20_ms, id()) < 0) {
      give_up("the device has no watchdog that releases the force if this program dies");
    }
    if (dhdEnableForce(DHD_ON, id()) < 0) {
      give_up("no force can be enabled");
    }
  }
  ~DhdDevice() override {
    dhdSetForce(0.0, 0.0, 0.0, id());
    dhdEnableForce(DHD_OFF, id());
    dhdClose(id());
  }

  bridge::wire::Introduction introduction() override {
    bridge::wire::Introduction told;
    told.workspace_radius_m = limits_.workspace_radius_m;
    told.max_force_n = limits_.max_force_n;
    told.max_stiffness_n_per_m = limits_.max_stiffness_n_per_m;
    told.rate_hz = 4000.0;
    unsigned short number = 0;
    dhdGetSerialNumber(&number, id());
    bridge::put_text(told.name, dhdGetSystemName(id()));
    bridge::put_text(told.serial_number, std::to_string(number));
    return told;
  }
  // The DHD's frame: x towards the operator, y to the right, z up.
  void exert(const bridge::wire::Vector& force_n) override {
    is_obeyed_ = dhdSetForce(force_n[2], force_n[0], force_n[1], id()) >= 0;
  }
  void sample(bridge::wire::Reply& reply) override {
    bridge::wire::Vector position_m{};
    bridge::wire::Vector velocity_m_s{};
    const int outcome = dhdGetPosition(&position_m[2], &position_m[0], &position_m[1], id());
    const bool is_read = outcome >= 0 && dhdGetLinearVelocity(&velocity_m_s[2], &velocity_m_s[0],
                                                              &velocity_m_s[1], id()) >= 0;
    if (is_read && outcome != DHD_TIMEGUARD) {  // else it is the sample before once more
      ++newest_.sample;
      newest_.position_m = position_m;
      newest_.velocity_m_s = velocity_m_s;
      taken_at_ = bridge::Clock::now();
    }
    const int buttons = static_cast<int>(dhdGetButtonMask(id()));
    newest_.buttons = buttons < 0 ? 0U : static_cast<std::uint32_t>(buttons);
    newest_.orientation.fill(std::nan(""));
    newest_.exerted_n.fill(std::nan(""));  // commanded, not measured
    newest_.exerted_n_m.fill(std::nan(""));
    reply = newest_;
    reply.age_s = bridge::seconds_since(taken_at_);
    if (!is_read || !is_obeyed_) {
      reply.status &= ~bridge::wire::motors_on;
      bridge::put_text(reply.text, dhdErrorGetLastStr());
    }
  }

 private:
  char id() const { return static_cast<char>(id_); }
  Limits limits_;
  int id_;
  bool is_obeyed_ = true;
  bridge::wire::Reply newest_;
  bridge::Clock::time_point taken_at_{};
};
}  // namespace

int main(int argc, char** argv) {
  const Limits limits =
      argc == 5 ? Limits{std::atof(argv[2]), std::atof(argv[3]), std::atof(argv[4])} : Limits{};
  if (!(limits.max_force_n > 0.0 && limits.max_stiffness_n_per_m > 0.0 &&
        limits.workspace_radius_m > 0.0)) {
    std::fputs("usage: dhd PORT MAX_FORCE_N MAX_STIFFNESS_N_PER_M WORKSPACE_RADIUS_M\n", stderr);
    return 2;
  }
  DhdDevice device{limits};
  bridge::Server{std::atoi(argv[1]), device}.run();
}
