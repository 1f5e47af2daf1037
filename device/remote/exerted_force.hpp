#pragma once
#include "core/haptic_state.hpp"
#include "core/tick_fault.hpp"
namespace tapstudy::device {
// Of a measured force: less may be an offset, noise, or lost in friction.
inline constexpr double noticeable_n = 0.5;

// Compares the force that a device reports with the force that it was sent. Faults are a report far
// above, in three ticks running; one against the commanded force, in six; and one of almost nothing
// along it for 30 ticks of force. Margins are wide, since devices measure late and coarsely. One
// that reports nothing (NaN) is not judged.
class ExertedForce {
 public:
  void forget() noexcept { *this = {}; }
  // Once a tick: what was commanded when the device reported.
  [[nodiscard]] core::TickFault judge(const core::Vec3& commanded_n,
                                      const core::Vec3& reported_n) noexcept;

 private:
  double recent_peak_n_{0.0};  // of the commands, decaying
  int ticks_above_{0};
  int ticks_against_{0};
  int ticks_without_{0};
};
}  // namespace tapstudy::device
