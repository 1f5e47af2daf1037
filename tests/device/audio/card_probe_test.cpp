// What a probe finds of a card in virtual time, whose every delay is known.
#include "device/audio/card_probe.hpp"

#include <algorithm>
#include <cmath>

#include "support/catch.hpp"
using namespace tapstudy;

namespace {
// Plays frames at its own rate once its buffer is full. Whoever writes wakes so much later than
// there is room, and in some periods a given time later.
class VirtualCard final : public device::PcmSink {
 public:
  VirtualCard(double rate_error, double lateness_ns)
      : frames_per_ns_{48e-6 * (1.0 + rate_error)}, lateness_ns_{lateness_ns} {}
  double rate_hz() const override { return 48'000.0; }
  std::size_t period_frames() const override { return 48; }
  std::size_t buffer_frames() const override { return 144; }
  std::optional<long> delay_frames() noexcept override { return std::lround(filled_); }
  void begin() noexcept override {}
  device::PcmOutcome write(std::span<const float> period) noexcept override {
    const auto frames = static_cast<double>(period.size());
    const double room_after_ns = std::max(0.0, (filled_ + frames - 144.0) / frames_per_ns_);
    const bool is_stalled = ++periods_ % stall_every == 0;
    const double wait_ns =
        is_playing_ ? room_after_ns + (is_stalled ? stall_ns : lateness_ns_) : 0.0;
    now_ns += wait_ns;
    filled_ -= is_playing_ ? wait_ns * frames_per_ns_ : 0.0;
    const bool has_gap = filled_ < 0.0;
    filled_ = std::max(filled_, 0.0) + frames;
    is_playing_ = !has_gap && (is_playing_ || filled_ >= 144.0);
    return has_gap ? device::PcmOutcome::underrun : device::PcmOutcome::played;
  }
  void end() noexcept override {}
  std::string failure() const override { return ""; }
  double now_ns{0.0};
  double stall_ns{0.0};
  static constexpr int stall_every = 1000;

 private:
  double frames_per_ns_;
  double lateness_ns_;
  double filled_{0.0};
  bool is_playing_{false};
  int periods_{0};
};

device::ProbedCard probed(VirtualCard& card, double seconds) {
  return device::probe_card(
      card, seconds,
      {[&] { return static_cast<std::int64_t>(card.now_ns); }, [](std::size_t /*frames*/) {}});
}
}  // namespace

TEST_CASE("a probe of a card finds its period, its buffer, its rate and how late it is served",
          "[device][audio][actuator]") {
  const double rate_error = GENERATE(-100e-6, 0.0, 100e-6);
  const double lateness_ns = GENERATE(0.0, 300e3);
  VirtualCard card{rate_error, lateness_ns};
  card.stall_ns = 1.5e6;
  const device::ProbedCard found = probed(card, 60.0);
  CAPTURE(rate_error, lateness_ns);
  CHECK(found.period_s == Approx(0.001));
  CHECK(found.buffer_s == Approx(0.003));
  CHECK(found.bridged() == 2'000'000);
  CHECK(found.gaps == 0);
  CHECK(found.lateness.count() == 60'000 - 2);  // the first two do not fill the buffer
  constexpr double frame_ns = 1e9 / 48e3;
  CHECK(static_cast<double>(found.lateness.quantile(0.5)) ==
        Approx(lateness_ns).epsilon(0.02).margin(frame_ns));
  CHECK(static_cast<double>(found.lateness.worst()) == Approx(1.5e6).margin(frame_ns));
  CHECK(found.rate_error == Approx(rate_error).margin(5e-6));
  CHECK_FALSE(found.loss);
}

TEST_CASE("of a card that tells nothing of what it has played no lateness is known",
          "[device][audio][actuator]") {
  struct Silent final : device::PcmSink {
    double rate_hz() const override { return 48'000.0; }
    std::size_t period_frames() const override { return 48; }
    std::size_t buffer_frames() const override { return 144; }
    std::optional<long> delay_frames() noexcept override { return told; }
    void begin() noexcept override {}
    device::PcmOutcome write(std::span<const float> /*period*/) noexcept override {
      return device::PcmOutcome::played;
    }
    void end() noexcept override {}
    std::string failure() const override { return ""; }
    std::optional<long> told;
  } card;
  card.told = GENERATE(std::optional<long>{}, std::optional<long>{0});
  std::int64_t now_ns = 0;
  const device::ProbedCard found = device::probe_card(
      card, 1.0, {[&] { return now_ns += 1'000'000; }, [](std::size_t /*frames*/) {}});
  CHECK(found.lateness.count() == 0);
  CHECK(found.gaps == 0);
}

TEST_CASE("a thread that wakes later than a card's buffer bridges makes a gap, each time",
          "[device][audio][actuator]") {
  VirtualCard card{0.0, 0.0};
  card.stall_ns = 2.1e6;
  const device::ProbedCard found = probed(card, 10.0);
  CHECK(found.gaps == 10'000 / VirtualCard::stall_every);
  CHECK(found.lateness.worst() <= found.bridged());
}
