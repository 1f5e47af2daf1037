#pragma once
#include <atomic>
#include <span>
#include <stop_token>

#include "core/placement.hpp"
#include "core/tick/tap_renderer.hpp"
#include "core/tick/trace_ring.hpp"
#include "device/device.hpp"
#include "device/loop/force_gate.hpp"
#include "device/loop/lateness.hpp"
#include "device/loop/tick_clock.hpp"
namespace tapstudy::device {
struct LoopReport {
  std::int64_t ticks{};
  std::int64_t late{};     // woke more than half a period after the deadline
  std::int64_t skipped{};  // periods in which no tick was made
  std::int64_t saturated{};
  LatenessCount lateness;
  core::TickFault stopped_by{core::TickFault::none};
};

struct LoopSettings {
  Nanoseconds period{1'000'000};
  core::GateSettings gate;
  core::Placement placement;
  int max_late_in_a_row{0};          // beyond it the loop gives up; 0: never
  Nanoseconds max_heartbeat_gap{0};  // likewise, for the heartbeat; 0: there is none
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
  // "I live", from the thread that looks after the trial.
  void beat() noexcept { has_beaten_.store(true, std::memory_order_release); }
  // Until asked to stop, which lets force fall gently, or a fault, which drops it. Leaves the
  // device at zero force.
  void run(const std::stop_token& stop) noexcept;
  // Some ticks and no more; the next call goes on from there.
  void run_ticks(std::int64_t count) noexcept;
  // Zero force, whatever came before.
  void zero_force() noexcept;

  const LoopReport& report() const noexcept { return report_; }

 private:
  void begin() noexcept;
  bool step() noexcept;  // false after a fault
  core::TickFault fault_of_time(Nanoseconds woke_at, Nanoseconds elapsed) noexcept;
  core::TraceSample unread_sample(Nanoseconds now) const noexcept;
  core::TraceSample tick(Nanoseconds now, Nanoseconds elapsed) noexcept;
  void render(const core::HandState& hand, double elapsed_s, core::TraceSample& sample) noexcept;
  void take_requested_alternative() noexcept;
  void note_lateness(Nanoseconds woke_at) noexcept;

  Device& device_;
  std::span<core::TapRenderer> alternatives_;
  LoopSettings settings_;
  core::SpscRing<core::TraceSample>& trace_;
  TickClock& clock_;
  ForceGate gate_;
  std::atomic<std::size_t> requested_{0};
  std::atomic<bool> has_beaten_{false};
  std::size_t current_{0};
  Nanoseconds start_{0};
  Nanoseconds deadline_{0};
  Nanoseconds last_beat_{0};
  Nanoseconds last_tick_{0};
  int late_in_a_row_{0};
  bool has_begun_{false};
  LoopReport report_;
};
}  // namespace tapstudy::device
