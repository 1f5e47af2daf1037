#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <type_traits>
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
  velocity_wrong,      // the device reports a velocity that is not the change of its position
  position_frozen,     // the device replies, but its position stands still while force is on
  periods_missed,      // more of the loop's periods than allowed, within a second
  actuator_gaps,       // more of them in the trial than the rig tolerates
  actuator_lost        // its card plays no more
};
// Message for the operator and the record; empty for none.
const char* to_text(TickFault fault) noexcept;

using Vec3 = Eigen::Vector3d;

// Two frames, both right-handed, in metres.
//   Device frame: origin at the middle of the workspace; +x right, +y up, +z towards the
//   participant. Device positions and forces are expressed in it.
//   Plate frame: origin at the middle of the plate's upper face; +x right, +y away from the
//   participant, +z out of the plate. Model, contact and tapping points are expressed in it.
// core/haptics/haptic_state.hpp converts between them.

// The haptic interaction point (HIP): what the device reported this tick, or the same seen in the
// plate frame.
// A vector that is initialised by {} has no value, unlike these defaults.
struct HandState {
  Vec3 position_m{Vec3::Zero()};
  Vec3 velocity_m_s{Vec3::Zero()};
};

// The parts of the force on the finger along the outward normal of the plate, before the limiter.
struct ForceParts {
  double penalty_n{0.0};    // the penalty force (paper eq. 1)
  double vibration_n{0.0};  // paper eq. 17; what a coupled finger adds to the penalty force
  double sinusoid_n{0.0};   // paper section 5.2.3
  double total_n() const noexcept { return penalty_n + vibration_n + sinusoid_n; }  // eq. 18
};

// One row of the trace; plain bytes so it can cross the ring buffer without allocating.
// Vectors are in the device frame; force_n is the commanded force, after the limiter, and
// achieved_n the force that the device reports: what its strings can exert of force_n (SPIDAR), or
// what was exerted when the position was read, so that of the tick before (remote).
struct TraceSample {
  std::int64_t t_ns;
  std::array<double, 3> position_m;
  std::array<double, 3> velocity_m_s;
  double penetration_m;
  double penalty_n;
  double vibration_n;
  double sinusoid_n;
  std::array<double, 3> force_n;
  std::array<double, 3> achieved_n;
  double pose_residual_m;    // for devices with redundant sensing
  double closure_margin;     // for string-driven devices: wrench closure if above zero
  double motor_voltage_v;    // mean over the motors, where the device measures it
  std::uint8_t alternative;  // which of the trial's alternatives was rendered
  bool touching;
  bool impact;     // the tick in which the plate was excited
  bool saturated;  // the limiter changed the force
  TickFault fault;
  std::uint8_t missed_replies;  // in a row: the position is the last one known, force fades
  bool late;  // the tick began more than half a period late, or force rises again after a gap
};
static_assert(std::is_trivially_copyable_v<TraceSample>);

// The plate's outward normal is the device frame's +y; defined only here.
inline constexpr Eigen::Index normal_axis = 1;
inline double along_normal(const Vec3& device_vector) noexcept {
  return device_vector[normal_axis];
}
inline double along_normal(const std::array<double, 3>& device_vector) noexcept {
  return device_vector[static_cast<std::size_t>(normal_axis)];
}

// The plate's place in the device's workspace. Along the normal the scale is 1 : 1, so that impact
// speed and penetration are physical; laterally one metre on the plate is `lateral_scale` metres on
// the device, because a plate is wide and a workspace is a few centimetres.
//   plate x = device x / scale,  plate y = -device z / scale,  plate z = device y,
// all relative to `origin_m`, the position of the plate frame's origin in the device frame.
// Forces are rotated between the frames but not scaled.
struct Placement {
  Vec3 origin_m{Vec3::Zero()};
  double lateral_scale{1.0};  // > 0

  // The placement of a plate with a lateral scale of its own, `ratio` times this.
  Placement scaled(double ratio) const noexcept { return {origin_m, ratio * lateral_scale}; }
  HandState to_plate(const HandState& hand) const noexcept {
    return {lengths_to_plate(hand.position_m - origin_m), lengths_to_plate(hand.velocity_m_s)};
  }
  Vec3 point_to_device(const Vec3& plate_point_m) const noexcept {
    return origin_m + Vec3{lateral_scale * plate_point_m.x(), plate_point_m.z(),
                           -lateral_scale * plate_point_m.y()};
  }
  static Vec3 force_to_device(const Vec3& plate_force_n) noexcept {
    return {plate_force_n.x(), plate_force_n.z(), -plate_force_n.y()};
  }

 private:
  Vec3 lengths_to_plate(const Vec3& device) const noexcept {
    return {device.x() / lateral_scale, -device.z() / lateral_scale, device.y()};
  }
};
}  // namespace tapstudy::core
