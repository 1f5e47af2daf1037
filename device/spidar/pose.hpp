#pragma once
#include <Eigen/Core>

#include "device/spidar/geometry.hpp"
namespace tapstudy::device {
// Of the grip, in the frame of the geometry.
struct Pose {
  core::Vec3 position_m{core::Vec3::Zero()};
  Eigen::Matrix3d rotation{Eigen::Matrix3d::Identity()};
};

// Rotation by |v| about v.
Eigen::Matrix3d rotation_of(const core::Vec3& rotation_vector_rad) noexcept;
core::Vec3 rotation_vector_rad(const Eigen::Matrix3d& rotation) noexcept;

// The structure matrix of the strings. Row i of pull is (u_i, r_i × u_i): the force and the torque
// about the grip centre due to a tension of 1 N in string i, with u_i the direction from the grip
// to the motor and r_i the attachment point on the rotated grip. Lengths change by
// -pull · (dp, dtheta).
struct Strings {
  PerString length_m;
  Eigen::Matrix<double, strings, 6> pull;  // 1 and m
};
Strings strings_at(const SpidarGeometry& geometry, const Pose& pose) noexcept;

struct FoundPose {
  Pose pose;
  Strings strings;      // at the pose
  double residual_m{};  // largest difference between measured and computed string lengths
  bool has_converged{};
};

// Forward kinematics: the pose with these string lengths, by Gauss-Newton from an initial guess;
// eight lengths and six unknowns leave a residual that reveals a slack, slipped or miscounted
// string. There is no damping: it would make the pose lag behind the hand.
FoundPose find_pose(const SpidarGeometry& geometry, const PerString& length_m, const Pose& guess,
                    int max_rounds) noexcept;
}  // namespace tapstudy::device
