#pragma once
#include <Eigen/Core>

#include "device/spidar/geometry.hpp"
namespace tapstudy::device {
// Of the grip, in the frame of the geometry.
struct Pose {
  core::Vec3 position_m{core::Vec3::Zero()};
  Eigen::Matrix3d rotation{Eigen::Matrix3d::Identity()};
};

// A turn by |v| about v.
Eigen::Matrix3d rotation_of(const core::Vec3& rotation_vector_rad) noexcept;
core::Vec3 rotation_vector_rad(const Eigen::Matrix3d& rotation) noexcept;

// How strings pull on a grip. Row i of pull is (u_i, r_i × u_i): the force and the torque about the
// grip's middle that a tension of 1 N in string i makes, with u_i the direction from the grip to
// the motor and r_i the string's end on the turned grip. Lengths change by -pull · (dp, dtheta).
struct Strings {
  PerString length_m;
  Eigen::Matrix<double, strings, 6> pull;  // 1 and m
};
Strings strings_at(const SpidarGeometry& geometry, const Pose& pose) noexcept;

struct FoundPose {
  Pose pose;
  Strings strings;      // at the pose
  double residual_m{};  // largest difference between a string as measured and as the pose has it
  bool has_converged{};
};

// The pose whose strings have these lengths, by Gauss-Newton from a guess; eight lengths and six
// unknowns leave a residual that tells a slack, slipped or miscounted string. There is no damping:
// it would let the pose lag behind the hand.
FoundPose find_pose(const SpidarGeometry& geometry, const PerString& length_m, const Pose& guess,
                    int max_rounds) noexcept;
}  // namespace tapstudy::device
