#pragma once
#include <cstdint>
namespace tapstudy::core {
// Faults that end a trial immediately, with all force removed.
enum class TickFault : std::uint8_t {
  none,
  device_gone,         // unplugged
  no_reply,            // within the timeout
  bad_reply,           // of the wrong length, or the transfer failed
  wrong_echo,          // the device echoed a command that was never sent
  counter_jumped,      // an encoder moved faster than a string can
  strings_disagree,    // inconsistent lengths: one is slack, slipped or miscounted
  not_homed,           // the device has not been homed
  outside_workspace,   // where forces can no longer be guaranteed
  too_fast,            // the hand
  non_finite_force,    // or position
  too_late,            // too many late ticks in a row
  heartbeat_lost,      // the supervising thread has stalled
  watchdog_expired,    // the whole program stalled; the guardian zeroed the force
  guardian_lost,       // the guardian process has ended, or is silent
  loop_stalled,        // a single tick came far too late
  suspended,           // the machine slept
  tensions_unsolved,   // no string tensions were found for the force
  stop_unconfirmed,    // the device did not acknowledge zero force at the end of the trial
  amplifier_off,       // the motors get no voltage although tension is commanded
  force_not_followed,  // the device reports a force far from the one commanded
  force_released,      // the device released the force in the middle of a trial
  velocity_wrong       // the device reports a velocity that is not the change of its position
};
// Message for the operator and the record; empty for none.
const char* to_text(TickFault fault) noexcept;
}  // namespace tapstudy::core
