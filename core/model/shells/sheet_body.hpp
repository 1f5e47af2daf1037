#pragma once
#include "core/model/shape/shape.hpp"
namespace tapstudy::core {
// The body between the faces of a sheet of this thickness on both sides of its middle: a
// consistently oriented surface, open or closed, smooth but at edges at which it turns by more than
// SmoothNormals::sharp_above_rad. Throws ModelError where it is folded back on itself.
Solid sheet_body(TriangleSurface middle, double thickness_m);

// The edges of its triangles at which it is folded.
std::size_t folds_of(const Sheet& sheet);

// Triangles of a sheet that are modelled: 48 unknowns each.
inline constexpr int max_sheet_triangles = 6000;
}  // namespace tapstudy::core
