#include "device/spidar/kinematics.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
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

namespace {
using Vec6 = Eigen::Matrix<double, 6, 1>;
constexpr double settled_m = 1e-7;
}  // namespace

Eigen::Matrix3d rotation_of(const core::Vec3& rotation_vector_rad) noexcept {
  const double angle = rotation_vector_rad.norm();
  return angle > 0.0 ? Eigen::AngleAxisd{angle, rotation_vector_rad / angle}.toRotationMatrix()
                     : Eigen::Matrix3d::Identity().eval();
}

core::Vec3 rotation_vector_rad(const Eigen::Matrix3d& rotation) noexcept {
  const Eigen::AngleAxisd turn{rotation};
  return turn.angle() * turn.axis();
}

Strings strings_at(const SpidarGeometry& geometry, const Pose& pose) noexcept {
  Strings found;
  for (Eigen::Index i = 0; i < strings; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const core::Vec3 end_m = pose.rotation * geometry.grip_m[k];
    const core::Vec3 string_m = geometry.motor_m[k] - pose.position_m - end_m;
    found.length_m[i] = string_m.norm();
    const core::Vec3 direction = string_m / found.length_m[i];
    found.pull.row(i) << direction.transpose(), end_m.cross(direction).transpose();
  }
  return found;
}

FoundPose find_pose(const SpidarGeometry& geometry, const PerString& length_m, const Pose& guess,
                    int max_rounds) noexcept {
  FoundPose found{guess, strings_at(geometry, guess)};
  for (int round = 0; round < max_rounds && !found.has_converged; ++round) {
    Strings now = found.strings;
    now.pull.rightCols<3>() /= grip_radius_m;
    const Eigen::Matrix<double, 6, 6> normal = now.pull.transpose() * now.pull;
    const Vec6 step_m = normal.ldlt().solve(now.pull.transpose() * (now.length_m - length_m));
    found.pose.position_m += step_m.head<3>();
    found.pose.rotation = rotation_of(step_m.tail<3>() / grip_radius_m) * found.pose.rotation;
    found.strings = strings_at(geometry, found.pose);
    found.has_converged = step_m.norm() < settled_m;
  }
  found.residual_m = (found.strings.length_m - length_m).cwiseAbs().maxCoeff();
  return found;
}
}  // namespace tapstudy::device
