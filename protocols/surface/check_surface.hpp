#pragma once
#include <string>

#include "core/error.hpp"
#include "core/geometry/triangle_surface.hpp"
#include "core/model/shape/shape.hpp"
namespace tapstudy::protocols {
// A fault that repair_surface may cure.
class SurfaceFault : public core::InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};
class SeveralPieces : public SurfaceFault {
 public:
  SeveralPieces(const std::string& what, bool are_nested)
      : SurfaceFault{what}, have_cavity{are_nested} {}
  bool have_cavity{};  // which every repair would fill
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

// The sheet around a surface in its middle, which is as check_surface says, but for rims that may
// be open. Throws InvalidInput, also where its faces run through themselves, or where it is less
// than `least_sheet_width` times wider (the root of its area) than thick.
inline constexpr double least_sheet_width = 20.0;
core::Solid checked_sheet(core::TriangleSurface middle, double thickness_m);
}  // namespace tapstudy::protocols
