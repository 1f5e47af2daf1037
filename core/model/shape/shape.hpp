#pragma once
#include <memory>
#include <string>
#include <variant>

#include "core/geometry/triangle_tree.hpp"
#include "core/model/shape/box.hpp"
namespace tapstudy::core {
// What lies within a closed surface (see check_surface), ready to be asked where it is met. Copies
// share it.
class Solid {
 public:
  explicit Solid(TriangleSurface surface);
  const TriangleSurface& surface() const { return triangles_->surface(); }
  const std::shared_ptr<const TriangleTree>& triangles() const { return triangles_; }
  const std::string& sha256() const { return sha256_; }  // of its points and triangles

 private:
  std::shared_ptr<const TriangleTree> triangles_;
  std::string sha256_;
};

// What a body looks like: a box, of which the upper face is tapped, or any other solid, tapped
// anywhere, in the plate frame as its file has it.
using Shape = std::variant<Box, Solid>;

struct Bounds {
  Vec3 low_m;
  Vec3 high_m;
  Vec3 size_m() const { return high_m - low_m; }
  // Points nearer than this are one: meshers stumble over finer detail.
  double snap_m() const { return 1e-6 * size_m().norm(); }
};
Bounds bounds(const TriangleSurface& surface);
Bounds bounds(const Shape& shape);

double volume_m3(const TriangleSurface& surface);  // negative if its normals point inward
double volume_m3(const Shape& shape);

// Equal text for shapes that are equal to the last bit.
std::string content_key(const Shape& shape);
}  // namespace tapstudy::core
