#pragma once
#include <array>

#include "core/geometry/triangle_tree.hpp"
#include "core/haptics/haptic_state.hpp"
namespace tapstudy::core {
// The contact state in this tick, in the plate frame.
struct Contact {
  bool touching{false};
  bool impact{false};               // an impact that excites the plate: true for one tick only
  double penetration_m{0.0};        // from the god-object to the haptic interaction point
  double impact_speed_m_s{0.0};     // approach speed, in the tick of the impact
  double normal_velocity_m_s{0.0};  // of the tip while it touches, outwards positive
  Vec3 god_object_m{Vec3::Zero()};  // the haptic interaction point, constrained to the surface
  Vec3 normal{Vec3::UnitZ()};       // outward unit normal: direction of the penalty force
  // The triangle under the god-object, on a surface of triangles, and the place on it.
  int triangle{TriangleTree::none};
  std::array<double, 3> barycentric{};
};

// State of the haptic interaction point before contact: handed from one contact to the next when
// the alternative is switched.
struct ContactHistory {
  Vec3 tip_m{Vec3::Zero()};
  bool has_tip{false};  // false until the first reading
  bool impact_armed{false};
};
}  // namespace tapstudy::core
