#pragma once
#include "core/error.hpp"
#include "core/geometry/triangle_surface.hpp"
namespace tapstudy::protocols {
// A fault that repair_surface may cure.
class SurfaceFault : public core::InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};
class SeveralPieces : public SurfaceFault {
 public:
  using SurfaceFault::SurfaceFault;
};

// As many as are modelled; repair_surface takes more, to make fewer of them.
inline constexpr int max_triangles = 200'000;
// Throws SurfaceFault beyond.
void check_count(const core::TriangleSurface& surface);

// Checks that a surface is a closed, consistently oriented, connected 2-manifold without
// self-intersections: finite points, non-degenerate triangles, every edge shared by two triangles
// in opposite directions, normals outward, one shell, no intersecting or overlapping triangles,
// between a millimetre and ten metres wide.
// Throws SurfaceFault, or InvalidInput for a wrong size, stating which condition is violated, and
// where.
void check_surface(const core::TriangleSurface& surface);
}  // namespace tapstudy::protocols
