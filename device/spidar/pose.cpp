#include "device/spidar/pose.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
namespace tapstudy::device {
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
