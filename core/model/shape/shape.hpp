#pragma once
#include <string>
#include <variant>

#include "core/geometry/triangle_surface.hpp"
#include "core/model/shape/box.hpp"
namespace tapstudy::core {
// What a body looks like: a box, of which the upper face is tapped, or a closed surface, tapped
// anywhere, in the plate frame as its file has it.
using Shape = std::variant<Box, TriangleSurface>;

struct Bounds {
  Vec3 low_m;
  Vec3 high_m;
  Vec3 size_m() const { return high_m - low_m; }
  // Points nearer than this are one: meshers stumble over finer detail.
  double snap_m() const { return 1e-6 * size_m().norm(); }
};
Bounds bounds(const Shape& shape);

double volume_m3(const TriangleSurface& surface);  // negative if its normals point inward
double volume_m3(const Shape& shape);

// Equal text for shapes that are equal to the last bit.
std::string content_key(const Shape& shape);
}  // namespace tapstudy::core
