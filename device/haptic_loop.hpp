#pragma once
#include <atomic>
#include <span>
#include <stop_token>

#include "core/placement.hpp"
#include "core/tick/force_limiter.hpp"
#include "core/tick/tap_renderer.hpp"
#include "core/tick/trace_ring.hpp"
#include "device/device.hpp"
#include "device/tick_clock.hpp"
namespace tapstudy::device {
struct LoopReport {
  std::int64_t ticks{};
  std::int64_t late{};     // woke more than half a period after the deadline
  std::int64_t skipped{};  // periods in which no tick was made
  std::int64_t saturated{};
  Nanoseconds worst_lateness{};
  core::TickFault stopped_by{core::TickFault::none};
};

struct LoopSettings {
  Nanoseconds period{1'000'000};
  core::ForceLimits limits;
  core::Placement placement;
};

// wait → read → render → limit → write → record, once a period, for one trial. The renderers are
// the trial's alternatives; a request to change is taken in the first tick without contact, so that
// no force law ever changes under the finger. All referenced objects must outlive the loop.
class HapticLoop {
 public:
  HapticLoop(Device& device, std::span<core::TapRenderer> alternatives, LoopSettings settings,
             core::SpscRing<core::TraceSample>& trace, TickClock& clock) noexcept;

  // May be called from any thread. index < number of alternatives.
  void request_alternative(std::size_t index) noexcept {
    requested_.store(index, std::memory_order_release);
  }
  // Until asked to stop or a fault. Leaves the device at zero force.
  void run(const std::stop_token& stop) noexcept;
  // Some ticks and no more; the next call goes on from there.
  void run_ticks(std::int64_t count) noexcept;
  // Zero force, whatever came before.
  void rest() noexcept;

  const LoopReport& report() const noexcept { return report_; }

 private:
  bool step() noexcept;  // false after a fault
  core::TraceSample tick(Nanoseconds now) noexcept;
  void take_requested_alternative() noexcept;
  void note_lateness(Nanoseconds woke_at) noexcept;

  Device& device_;
  std::span<core::TapRenderer> alternatives_;
  LoopSettings settings_;
  core::SpscRing<core::TraceSample>& trace_;
  TickClock& clock_;
  std::atomic<std::size_t> requested_{0};
  std::size_t current_{0};
  Nanoseconds start_;
  Nanoseconds deadline_;
  core::Vec3 previous_force_n_{core::Vec3::Zero()};
  LoopReport report_;
};
}  // namespace tapstudy::device
