#pragma once
#include "core/geometry/triangle_surface.hpp"
namespace tapstudy::protocols {
// A wrap lies outside what it wraps by this share of the distance that it bridges.
inline constexpr double wrap_offset_share = 1.0 / 30.0;
// That around a sheet: twice this is its thickness, of which a mesh bears only so little.
inline constexpr double skin_offset_share = 1.0 / 6.0;

// A closed surface around any triangles, which bridges gaps up to the distance and lies outside by
// the offset (alpha wrapping: Portaneri et al., 2022, in CGAL). Throws ModelError if that
// takes too long or too much memory.
core::TriangleSurface wrapped(const core::TriangleSurface& surface, double distance_m,
                              double offset_m);

// The same closed surface with at most so many triangles: edges are collapsed in the order of their
// cost (Lindstrom and Turk, 1998, in CGAL). Throws ModelError if that takes too long or too much
// memory.
core::TriangleSurface simplified(const core::TriangleSurface& surface, int max_triangles);
}  // namespace tapstudy::protocols
