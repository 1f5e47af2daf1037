#pragma once
#include <functional>

#include "core/geometry/triangle_surface.hpp"
#include "core/model/shape/shape.hpp"
namespace tapstudy::protocols {
// Each triangle that has an area, with corners of its own: a tree of them (TriangleTree) needs no
// neighbours, so that this holds for surfaces that enclose no body, too.
core::TriangleSurface parted(const core::TriangleSurface& surface);

// Visits points of each triangle, its corners and centre among them, no further apart than apart_m
// or a fiftieth of its longest side; until a visit returns false.
void visit_points(const core::TriangleSurface& surface, double apart_m,
                  const std::function<bool(const core::Vec3& at_m)>& visit);
}  // namespace tapstudy::protocols
