#pragma once
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "core/geometry/triangle_tree.hpp"
#include "core/haptics/haptic_state.hpp"
namespace tapstudy::core {
// A rectangular plate, in the plate frame: x in ±size.x/2, y in ±size.y/2, and z from -size.z up to
// 0, the tapped face.
struct Box {
  Vec3 size_m;  // each > 0
  Vec3 low_m() const { return {-0.5 * size_m.x(), -0.5 * size_m.y(), -size_m.z()}; }
  Vec3 high_m() const { return {0.5 * size_m.x(), 0.5 * size_m.y(), 0.0}; }
};

// A sheet of equal thickness, by the surface in its middle, open or closed.
struct Sheet {
  TriangleSurface middle;
  double thickness_m{};
};

// A solid bounded by a closed surface (see check_surface), with its collision tree. Copies share
// the data.
class Solid {
 public:
  // simplified_by: the command that makes a surface of fewer triangles of this one's file, for
  // errors; empty: none is known.
  explicit Solid(TriangleSurface surface, std::string simplified_by = {});
  // Bounded by the faces and rims of a sheet (shells/sheet_body.hpp).
  Solid(TriangleSurface faces, Sheet sheet);
  const std::string& simplified_by() const { return simplified_by_; }
  const std::shared_ptr<const Sheet>& sheet() const { return sheet_; }  // nullptr: it is none
  const TriangleSurface& surface() const { return triangles_->surface(); }
  const std::shared_ptr<const TriangleTree>& triangles() const { return triangles_; }
  const std::string& sha256() const { return sha256_; }  // of its points and triangles

 private:
  std::shared_ptr<const TriangleTree> triangles_;
  std::shared_ptr<const Sheet> sheet_;
  std::string sha256_;
  std::string simplified_by_;
};

// The geometry of a body: a box, tapped on its upper face, or any other solid, tapped anywhere,
// with its file's coordinates taken as the plate frame.
using Shape = std::variant<Box, Solid>;

struct Bounds {
  Vec3 low_m;
  Vec3 high_m;
  Vec3 size_m() const { return high_m - low_m; }
  // Points closer than this are merged: meshers fail on finer detail.
  double snap_m() const { return 1e-6 * size_m().norm(); }
};
Bounds bounds(const TriangleSurface& surface);
Bounds bounds(const Shape& shape);

double volume_m3(const TriangleSurface& surface);  // negative if its normals point inward
double volume_m3(const Shape& shape);

// Identical text for bitwise identical shapes.
std::string content_key(const Shape& shape);

// The height at which a finger descending along -z first touches a body.
class TopHeight {
 public:
  explicit TopHeight(const Shape& shape);
  // z in the plate frame; nullopt where the vertical line misses the body.
  std::optional<double> at_m(const Eigen::Vector2d& sideways_m) const;
  // For messages, the region that can be touched from above: a plate's extent, or the place on a
  // body nearest to a point that misses it.
  std::string describe_touchable(const Eigen::Vector2d& sideways_m) const;

 private:
  Bounds bounds_;
  std::shared_ptr<const TriangleTree> triangles_;  // none of a box
};
}  // namespace tapstudy::core
