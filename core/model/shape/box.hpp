#pragma once
#include "core/haptic_state.hpp"
namespace tapstudy::core {
// A rectangular plate, in the plate frame: x in ±size.x/2, y in ±size.y/2, and z from -size.z up to
// 0, the tapped face.
struct Box {
  Vec3 size_m;  // each > 0
  Vec3 low_m() const { return {-0.5 * size_m.x(), -0.5 * size_m.y(), -size_m.z()}; }
  Vec3 high_m() const { return {0.5 * size_m.x(), 0.5 * size_m.y(), 0.0}; }
};
}  // namespace tapstudy::core
