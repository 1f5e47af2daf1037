#pragma once
#include <cstdint>
namespace tapstudy::core {
// What ends a trial at once, with no force left on.
enum class TickFault : std::uint8_t {
  none,
  device_gone,        // unplugged
  no_reply,           // in time
  bad_reply,          // of the wrong length, or the transfer failed
  wrong_echo,         // the device says it got what was never sent
  counter_jumped,     // an encoder moved faster than a string can
  strings_disagree,   // no pose fits all of them: one is slack, slipped or miscounted
  not_homed,          // nobody has shown the device where its middle is
  outside_workspace,  // where the device could not keep its promise of force
  too_fast,           // the hand
  non_finite_force,   // or position
  too_late,           // a run of late ticks
  heartbeat_lost,     // the program around the loop has stopped
  stood_still,        // the whole program did; its guardian took the force off
  guardian_lost       // nobody would take the force off should the program die
};
// In words, for people and for the record; empty for none.
const char* to_text(TickFault fault) noexcept;
}  // namespace tapstudy::core
