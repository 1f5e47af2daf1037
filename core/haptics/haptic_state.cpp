#include "core/haptics/haptic_state.hpp"

namespace tapstudy::core {
const char* to_text(TickFault fault) noexcept {
  switch (fault) {
    case TickFault::none:
      return "";
    case TickFault::device_gone:
      return "the device is gone";
    case TickFault::no_reply:
      return "the device did not reply in time";
    case TickFault::bad_reply:
      return "the device's reply was broken";
    case TickFault::wrong_echo:
      return "the device echoed a command that was not sent";
    case TickFault::counter_jumped:
      return "an encoder jumped";
    case TickFault::strings_disagree:
      return "the string lengths are consistent with no pose (slack, slipped or miscounted)";
    case TickFault::not_homed:
      return "the device must be homed first";
    case TickFault::outside_workspace:
      return "the hand left the workspace";
    case TickFault::too_fast:
      return "the hand was too fast";
    case TickFault::non_finite_force:
      return "a force or position was not finite";
    case TickFault::loop_stalled:
      return "the loop stalled for longer than the rig allows";
    case TickFault::suspended:
      return "the machine was suspended";
    case TickFault::stop_unconfirmed:
      return "the device did not acknowledge zero force";
    case TickFault::amplifier_off:
      return "the motors get no voltage (is the amplifier on?)";
    case TickFault::force_not_followed:
      return "the device reports a force far from the one it was sent";
    case TickFault::force_released:
      return "the device released the force because no requests arrived";
    case TickFault::velocity_wrong:
      return "the device reports a velocity that is not the change of its position (in m/s?)";
    case TickFault::position_frozen:
      return "the device replies, but its position stands still under force or is old (encoders?)";
    case TickFault::periods_missed:
      return "too many of the loop's periods were missed within a second: the device replies late, "
             "or the machine is busy (tapstudy doctor --rig measures both)";
    case TickFault::actuator_gaps:
      return "the actuator's card had more gaps than actuator.max_gaps (tapstudy doctor --rig)";
    case TickFault::actuator_lost:
      return "the actuator's sound card plays no more (is it plugged in?)";
    case TickFault::tensions_unsolved:
      return "no string tensions were found for the force";
    case TickFault::too_late:
      return "the loop was late in each tick for longer than the rig allows";
    case TickFault::watchdog_expired:
      return "the program stalled; the watchdog removed the force";
    case TickFault::guardian_lost:
      return "the watchdog process has ended";
    case TickFault::heartbeat_lost:
      return "the session's supervising thread stalled";
  }
  return "";
}
}  // namespace tapstudy::core
