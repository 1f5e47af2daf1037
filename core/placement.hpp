#pragma once
#include "core/haptic_state.hpp"
namespace tapstudy::core {
// The plate's outward normal is the device frame's +y; defined only here.
inline constexpr Eigen::Index normal_axis = 1;
inline double along_normal(const Vec3& device_vector) noexcept {
  return device_vector[normal_axis];
}
inline double along_normal(const std::array<double, 3>& device_vector) noexcept {
  return device_vector[static_cast<std::size_t>(normal_axis)];
}

// Where the plate lies in the device's workspace. Along the normal the scale is 1 : 1, so that
// impact speed and penetration are physical; laterally one metre on the plate is `lateral_scale`
// metres on the device, because a plate is wide and a workspace is a few centimetres.
//   plate x = device x / scale,  plate y = -device z / scale,  plate z = device y,
// all relative to `origin_m`, the position of the plate frame's origin in the device frame.
// Forces are rotated between the frames but not scaled.
struct Placement {
  Vec3 origin_m{Vec3::Zero()};
  double lateral_scale{1.0};  // > 0

  // Of a plate with a lateral scale of its own, `ratio` times this.
  Placement scaled(double ratio) const noexcept { return {origin_m, ratio * lateral_scale}; }
  HandState to_plate(const HandState& hand) const noexcept {
    return {lengths_to_plate(hand.position_m - origin_m), lengths_to_plate(hand.velocity_m_s)};
  }
  Vec3 point_to_device(const Vec3& plate_point_m) const noexcept {
    return origin_m + Vec3{lateral_scale * plate_point_m.x(), plate_point_m.z(),
                           -lateral_scale * plate_point_m.y()};
  }
  static Vec3 force_to_device(const Vec3& plate_force_n) noexcept {
    return {plate_force_n.x(), plate_force_n.z(), -plate_force_n.y()};
  }

 private:
  Vec3 lengths_to_plate(const Vec3& device) const noexcept {
    return {device.x() / lateral_scale, -device.z() / lateral_scale, device.y()};
  }
};
}  // namespace tapstudy::core
