#pragma once
#include <algorithm>
#include <memory>
#include <stop_token>
#include <vector>

#include "core/haptics/haptic_state.hpp"
#include "core/techniques/technique.hpp"
#include "core/tick/spsc_ring.hpp"
#include "device/loop/haptic_loop.hpp"
namespace tapstudy::testing {
// What a loop has traced since the last call.
inline std::vector<core::TraceSample> samples_of(core::SpscRing<core::TraceSample>& trace) {
  std::vector<core::TraceSample> all;
  core::TraceSample sample{};
  while (trace.try_pop(sample)) {
    all.push_back(sample);
  }
  return all;
}

// Time that passes as told, late from now on if so told.
class SteadyClock : public device::TickClock {
 public:
  device::Nanoseconds now() noexcept override { return now_; }
  device::Nanoseconds wait_until(device::Nanoseconds deadline) noexcept final {
    pass_to(deadline + lateness);
    return now();
  }
  device::Nanoseconds suspended() noexcept final { return slept; }
  device::Nanoseconds lateness{0};
  device::Nanoseconds slept{0};

 protected:
  virtual void pass_to(device::Nanoseconds moment) noexcept { now_ = std::max(now_, moment); }

 private:
  device::Nanoseconds now_{0};
};

// The time of a program or of a pipe that has its own.
template <class Timed>
class ClockOf final : public SteadyClock {
 public:
  explicit ClockOf(Timed& timed) : timed_{timed} {}
  device::Nanoseconds now() noexcept override { return timed_.now(); }
  void pass_to(device::Nanoseconds moment) noexcept override { timed_.wait_until(moment); }

 private:
  Timed& timed_;
};

// The loop with a plate of 3000 N/m, on any device, to be driven into each of its states.
class StagedLoop {
 public:
  StagedLoop(device::Device& device, SteadyClock& its_clock, double workspace_radius_m = 0.02)
      : clock{its_clock} {
    renderers_.push_back(core::make_renderer(*core::find_technique("none"), core::RenderSettings{},
                                             core::PlateFace{0.3, 0.3}, nullptr));
    device::LoopSettings settings;
    settings.gate = {{5.0, 5000.0}, 1.0, workspace_radius_m, 0.1, 0.1};
    settings.max_late_in_a_row = 20;
    settings.max_missed_share = 0.01;
    settings.max_stall = 10'000'000;
    settings.max_heartbeat_gap = 100'000'000;
    loop = std::make_unique<device::HapticLoop>(device, renderers_, settings, trace_, clock);
  }
  void tick(int count) {
    for (int i = 0; i < count; ++i) {
      loop->beat();
      loop->run_ticks(1);
    }
  }
  // As at the end of a trial.
  void stop() {
    std::stop_source stop;
    stop.request_stop();
    loop->run(stop.get_token());
  }
  core::TraceSample last_sample() {
    core::TraceSample sample{};
    while (trace_.try_pop(sample)) {
    }
    return sample;
  }

  SteadyClock& clock;
  std::unique_ptr<device::HapticLoop> loop;

 private:
  std::vector<core::TapRenderer> renderers_;
  core::SpscRing<core::TraceSample> trace_{8192};
};

}  // namespace tapstudy::testing
