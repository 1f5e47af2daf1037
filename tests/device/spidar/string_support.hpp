#pragma once
#include "core/random/rng.hpp"
#include "device/spidar/kinematics.hpp"
namespace tapstudy::testing {
// Uniform in a cube of this half width.
inline core::Vec3 random_vector(core::Rng& rng, double half_width) {
  const auto one = [&] { return half_width * (2.0 * rng.uniform() - 1.0); };
  const double x = one();
  const double y = one();
  return {x, y, one()};
}
inline device::Pose random_pose(core::Rng& rng, double half_width_m, double half_turn_rad) {
  const core::Vec3 position_m = random_vector(rng, half_width_m);
  return {position_m, device::rotation_of(random_vector(rng, half_turn_rad))};
}
inline double turn_between(const device::Pose& a, const device::Pose& b) {
  return device::rotation_vector_rad(a.rotation.transpose() * b.rotation).norm();
}
}  // namespace tapstudy::testing
