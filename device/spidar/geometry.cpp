#include "device/spidar/geometry.hpp"

#include <numbers>

#include "core/error.hpp"
namespace tapstudy::device {
namespace {
// The aluminium frame of the SPIDAR-G6, type X3: a box of 0.12 × 0.152 × 0.12 m turned by 45
// degrees about y, so that motors stand on the axes; a grip with four points 22.5 mm from its
// middle. (Springhead's table of types.)
constexpr double out_m = 0.060 * std::numbers::sqrt2;
constexpr double up_m = 0.076;
constexpr double side_m = grip_radius_m / std::numbers::sqrt2;

// Strings 5 to 8 are the first four mirrored in a horizontal plane.
SpidarGeometry mirrored(std::string type, const std::array<core::Vec3, 4>& motors,
                        const std::array<core::Vec3, 4>& grips) {
  SpidarGeometry geometry{std::move(type), {}, {}};
  const auto mirror = [](const core::Vec3& v) { return core::Vec3{v.x(), -v.y(), v.z()}; };
  for (std::size_t i = 0; i < 4; ++i) {
    geometry.motor_m.at(i) = motors.at(i);
    geometry.motor_m.at(i + 4) = mirror(motors.at(i));
    geometry.grip_m.at(i) = grips.at(i);
    geometry.grip_m.at(i + 4) = mirror(grips.at(i));
  }
  return geometry;
}
}  // namespace

std::vector<std::string> spidar_types() {
  return {"X3R", "X3L"};
}

SpidarGeometry spidar_geometry(const std::string& type) {
  if (type == "X3R") {
    return mirrored(
        type,
        {{{-out_m, -up_m, 0.0}, {0.0, -up_m, out_m}, {out_m, -up_m, 0.0}, {0.0, -up_m, -out_m}}},
        {{{-side_m, 0.0, -side_m},
          {side_m, 0.0, side_m},
          {0.0, -grip_radius_m, 0.0},
          {0.0, -grip_radius_m, 0.0}}});
  }
  if (type == "X3L") {
    return mirrored(
        type, {{{out_m, up_m, 0.0}, {0.0, up_m, out_m}, {-out_m, up_m, 0.0}, {0.0, up_m, -out_m}}},
        {{{side_m, 0.0, -side_m},
          {-side_m, 0.0, side_m},
          {0.0, grip_radius_m, 0.0},
          {0.0, grip_radius_m, 0.0}}});
  }
  throw core::InvalidInput{
      "type: '" + type + "' is not a known SPIDAR-G6 (one of: X3R, X3L" +
      (type == "X3F" ? "; the strings of an X3F do not give wrench closure)" : ")")};
}
}  // namespace tapstudy::device
