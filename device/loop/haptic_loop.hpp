#pragma once
#include <array>
#include <atomic>
#include <span>
#include <stop_token>

#include "core/haptics/haptic_state.hpp"
#include "core/tick/actuator_voice.hpp"
#include "core/tick/spsc_ring.hpp"
#include "core/tick/tap_renderer.hpp"
#include "device/device.hpp"
#include "device/hand/scripted_hand.hpp"
#include "device/loop/force_gate.hpp"
#include "device/loop/missed_periods.hpp"
#include "device/loop/tick_clock.hpp"
namespace tapstudy::device {
struct LoopReport {
  std::int64_t ticks{};
  std::int64_t late{};     // woke more than half a period after the deadline
  std::int64_t skipped{};  // periods in which no tick was made
  std::int64_t saturated{};
  std::int64_t bridged{};  // ticks on the last known position, for want of a reply
  LatenessCount lateness;
  StopOutcome stop{StopOutcome::confirmed};  // whether zero force was acknowledged at the end
  core::TickFault stopped_by{core::TickFault::none};
};

struct LoopSettings {
  Nanoseconds period{1'000'000};
  core::GateSettings gate;
  core::Placement placement;
  int max_late_in_a_row{0};          // a longer run is a fault; 0: unlimited
  Nanoseconds max_stall{0};          // a longer time between two ticks is a fault; 0: unlimited
  double max_missed_share{1.0};      // of the periods of a second; a larger one is a fault
  Nanoseconds max_heartbeat_gap{0};  // a longer gap is a fault; 0: no heartbeat
};

inline constexpr std::size_t max_alternatives = 128;  // traces have a byte for it

// An actuator beside the device: it is told of every tick, and what fails it is a fault of the
// loop.
struct ActuatorLink {
  core::SpscRing<core::ActuatorTick>* ticks{nullptr};
  const std::atomic<core::TickFault>* fault{nullptr};
};

// wait → read → render → limit → write → record, once per period, for one trial. The renderers are
// the trial's alternatives; a switch request takes effect in the first tick without contact, so
// that the force law never changes during contact. A period that was missed is not made up for in
// force, but vibrations advance by it, so that they keep their pitch, as does the scripted hand. At
// most max_alternatives. All referenced objects
// must outlive the loop.
//
// Where a scripted hand taps, the device's hand feels what the scripted one feels: its position
// does not matter to contact, only to safety, and the trace has the scripted hand's. It taps anew
// with each switch and after each silence.
class HapticLoop {
 public:
  HapticLoop(Device& device, std::span<core::TapRenderer> alternatives, LoopSettings settings,
             core::SpscRing<core::TraceSample>& trace, TickClock& clock,
             ScriptedHand* taps = nullptr) noexcept;

  // Before the first tick.
  void use(const ActuatorLink& actuator) noexcept { actuator_ = actuator; }
  // May be called from any thread. index < number of alternatives.
  void request_alternative(std::size_t index) noexcept {
    requested_.store(index, std::memory_order_release);
  }
  // May be called from any thread: renders nothing from the next tick without contact on, or
  // renders again from such a tick on, so that force neither ends nor begins in contact.
  void request_silence(bool is_silent) noexcept {
    silence_requested_.store(is_silent, std::memory_order_release);
  }
  // May be called from any thread: whether what was requested last is in effect.
  bool is_as_requested() const noexcept {
    return rendering_.load(std::memory_order_acquire) ==
           (silence_requested_.load(std::memory_order_acquire)
                ? nothing
                : requested_.load(std::memory_order_acquire));
  }
  // May be called from any thread: how often the finger has come down on an alternative.
  int contacts(std::size_t alternative) const noexcept {
    return contacts_.at(alternative).load(std::memory_order_acquire);
  }
  // Heartbeat from the thread that supervises the trial.
  void beat() noexcept { has_beaten_.store(true, std::memory_order_release); }
  // Runs until a stop request, on which force is ramped down, or a fault, on which it is removed at
  // once. Leaves the device at zero force.
  void run(const std::stop_token& stop) noexcept;
  // Runs the given number of ticks; the next call continues from there.
  void run_ticks(std::int64_t count) noexcept;
  // Commands zero force; after a fault the emergency stop has done so.
  void zero_force() noexcept;

  const LoopReport& report() const noexcept { return report_; }
  // May be called from any thread: when its first tick was due, by its clock, from which times in
  // the trace count; 0 before.
  Nanoseconds began_at() const noexcept { return start_.load(std::memory_order_acquire); }
  // May be called from any thread: whether a tick was made lately, so that what happens now happens
  // to somebody who feels the plate. False in a stall, even before the loop has found it.
  bool is_ticking(Nanoseconds now) const noexcept {
    return settings_.max_stall == 0 ||
           now - ticked_at_.load(std::memory_order_acquire) <= settings_.max_stall;
  }

 private:
  static constexpr std::size_t nothing = max_alternatives;
  void begin() noexcept;
  bool step() noexcept;  // false after a fault
  core::TickFault fault_of_time(Nanoseconds woke_at, Nanoseconds elapsed) noexcept;
  core::TickFault fault_of_absence(Nanoseconds elapsed) noexcept;
  core::TickFault fault_of_lateness() const noexcept;
  core::TickFault fault_of_actuator() const noexcept;
  double bridging_share(const DeviceDetail& detail, Nanoseconds elapsed) noexcept;
  core::TraceSample unread_sample(Nanoseconds now) const noexcept;
  core::TraceSample tick(Nanoseconds now, Nanoseconds elapsed) noexcept;
  void render(const core::HandState& hand, double share, double elapsed_s,
              core::TraceSample& sample) noexcept;
  core::RenderedTick follow(const core::HandState& hand, core::TraceSample& sample) noexcept;
  core::RenderedTick follow_taps(int periods, core::TraceSample& sample) noexcept;
  void tell_actuator(const core::RenderedTick& rendered, const core::Vec3& passed_n) noexcept;
  void tell_actuator_of_end() noexcept;
  void take_requests() noexcept;
  void note_lateness(Nanoseconds woke_at) noexcept;

  Device& device_;
  std::span<core::TapRenderer> alternatives_;
  LoopSettings settings_;
  core::SpscRing<core::TraceSample>& trace_;
  TickClock& clock_;
  ScriptedHand* taps_;  // nullptr: the device's hand taps
  ActuatorLink actuator_;
  ForceGate gate_;
  std::atomic<std::size_t> requested_{0};
  std::atomic<bool> silence_requested_{false};
  std::atomic<std::size_t> rendering_{0};  // an alternative, or nothing
  std::atomic<bool> has_beaten_{false};
  std::atomic<Nanoseconds> ticked_at_{0};
  std::size_t current_{0};
  bool is_silent_{false};
  std::array<std::atomic<int>, max_alternatives> contacts_{};
  std::atomic<Nanoseconds> start_{0};
  Nanoseconds deadline_{0};
  Nanoseconds last_beat_{0};
  Nanoseconds last_tick_{0};
  Nanoseconds suspended_before_{0};
  int late_in_a_row_{0};
  Nanoseconds missed_{0};  // periods, just before this tick
  MissedPeriods missed_lately_;
  core::Vec3 on_taps_n_{core::Vec3::Zero()};  // the force on the scripted hand
  bool has_begun_{false};
  bool was_bridged_{false};
  double unread_s_{0.0};  // since the position was last read
  core::TickFault fault_at_begin_{core::TickFault::none};
  LoopReport report_;
};
}  // namespace tapstudy::device
