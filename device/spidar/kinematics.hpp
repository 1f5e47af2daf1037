#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "core/haptics/haptic_state.hpp"
#include "core/settings/device_settings.hpp"
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

// The device frame (core/haptics/haptic_state.hpp) has +z towards the participant. Its own inverse.
inline core::Vec3 with_z_turned(const core::Vec3& v) noexcept {
  return {v.x(), v.y(), -v.z()};
}

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
