#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "core/haptic_state.hpp"
#include "core/settings/spidar_calibration.hpp"
namespace tapstudy::device {
inline constexpr int strings = core::spidar_strings;
// From the grip's middle to its four points; also what makes a turn and a shift alike in size.
inline constexpr double grip_radius_m = 0.0225;
using PerString = Eigen::Matrix<double, strings, 1>;

// A grip held by eight strings, each from its motor's exit to a point of the grip. The frame is
// that of the maker: origin at the middle of the frame, +x right, +y up, +z away from the
// participant; metres. String i and i + 4 end at one point or at two facing ones.
struct SpidarGeometry {
  std::string type;
  std::array<core::Vec3, strings> motor_m;
  std::array<core::Vec3, strings> grip_m;  // from the grip's middle, at rest
};

// Throws InvalidInput for a type there is no trustworthy geometry of, with the ones there are.
SpidarGeometry spidar_geometry(const std::string& type);
std::vector<std::string> spidar_types();

// Device frames (core/haptic_state.hpp) have +z towards the participant. Both ways.
inline core::Vec3 with_z_turned(const core::Vec3& v) noexcept {
  return {v.x(), v.y(), -v.z()};
}
}  // namespace tapstudy::device
