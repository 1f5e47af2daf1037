// loop_bench PRIORITY PERIOD_US TICKS: the haptic loop on a device that does nothing; prints how
// late it woke, one number in nanoseconds a tick.
#include <fmt/format.h>

#include <cstdlib>
#include <thread>
#include <vector>

#include "core/techniques/technique.hpp"
#include "device/loop/haptic_loop.hpp"
#include "device/loop/realtime.hpp"
using namespace tapstudy;
namespace {
class Nothing final : public device::Device {
 public:
  core::TickFault read(core::HandState& hand, double /*elapsed_s*/) noexcept override {
    hand = {core::Vec3::Zero(), core::Vec3::Zero()};
    return {};
  }
  core::TickFault write(const core::Vec3& /*force_n*/) noexcept override { return {}; }
  device::DeviceDetail detail() const noexcept override { return {}; }
  std::string description() const override { return "nothing"; }
};

class Noted final : public device::TickClock {
 public:
  explicit Noted(std::size_t ticks) { lateness_.reserve(ticks); }
  device::Nanoseconds now() noexcept override { return clock_.now(); }
  device::Nanoseconds wait_until(device::Nanoseconds deadline) noexcept override {
    const device::Nanoseconds woke_at = clock_.wait_until(deadline);
    lateness_.push_back(woke_at - deadline);
    return woke_at;
  }
  const std::vector<device::Nanoseconds>& lateness() const { return lateness_; }

 private:
  device::MonotonicClock clock_;
  std::vector<device::Nanoseconds> lateness_;
};
}  // namespace

int main(int count, char** words) {
  if (count != 4) {
    return 2;
  }
  const auto ticks = std::atol(words[3]);
  Nothing device;
  Noted clock{static_cast<std::size_t>(ticks)};
  std::vector<core::TapRenderer> renderers;
  renderers.push_back(core::make_renderer(*core::find_technique("none"), core::RenderSettings{},
                                          core::PlateFace{0.3, 0.3}, nullptr));
  core::SpscRing<core::TraceSample> trace{1024};
  device::LoopSettings settings;
  settings.period = 1000 * std::atol(words[2]);
  device::HapticLoop loop{device, renderers, settings, trace, clock};
  std::jthread{[&] {
    device::ask_for_realtime({std::atoi(words[1]), true, {}});
    loop.run_ticks(ticks);
  }}.join();
  if (const core::TickFault fault = loop.report().stopped_by; fault != core::TickFault::none) {
    fmt::print(stderr, "loop_bench: {}\n", to_text(fault));
    return 1;
  }
  for (const device::Nanoseconds lateness : clock.lateness()) {
    fmt::print("{}\n", lateness);
  }
}
