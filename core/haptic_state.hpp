#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <type_traits>

#include "core/tick_fault.hpp"
namespace tapstudy::core {
using Vec3 = Eigen::Vector3d;

// Two frames, both right-handed, in metres.
//   Device frame: origin at the middle of the workspace; +x right, +y up, +z towards the
//   participant. Device positions and forces are expressed in it.
//   Plate frame: origin at the middle of the plate's upper face; +x right, +y away from the
//   participant, +z out of the plate. Model, contact and tapping points are expressed in it.
// core/placement.hpp converts between them.

// The haptic interaction point (HIP): what the device reported this tick, or the same seen in the
// plate frame.
struct HandState {
  Vec3 position_m{Vec3::Zero()};
  Vec3 velocity_m_s{Vec3::Zero()};
};

// The parts of the force on the finger along the outward normal of the plate, before the limiter.
struct ForceParts {
  double penalty_n{0.0};    // the penalty force (paper eq. 1)
  double vibration_n{0.0};  // paper eq. 17, or of a coupled finger
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
}  // namespace tapstudy::core
