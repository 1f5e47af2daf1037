#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "core/haptic_state.hpp"
#include "core/settings/spidar_calibration.hpp"
namespace tapstudy::device {
inline constexpr int strings = core::spidar_strings;
// Distance of the four attachment points from the grip centre; also scales rotations to lengths.
inline constexpr double grip_radius_m = 0.0225;
using PerString = Eigen::Matrix<double, strings, 1>;

// A grip held by eight strings, each from its motor's exit to an attachment point on the grip. In
// the manufacturer's coordinates: origin at the centre of the frame, +x right, +y up, +z away from
// the participant; metres. Strings i and i + 4 end at the same point or at two opposite ones.
struct SpidarGeometry {
  std::string type;
  std::array<core::Vec3, strings> motor_m;
  std::array<core::Vec3, strings> grip_m;  // from the grip centre, at rest
};

// Throws InvalidInput, listing the known types, for a type without a reliable geometry.
SpidarGeometry spidar_geometry(const std::string& type);
std::vector<std::string> spidar_types();

// The device frame (core/haptic_state.hpp) has +z towards the participant. Its own inverse.
inline core::Vec3 with_z_turned(const core::Vec3& v) noexcept {
  return {v.x(), v.y(), -v.z()};
}
}  // namespace tapstudy::device
