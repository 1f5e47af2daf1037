#pragma once
#include <array>
#include <numbers>
#include <optional>
#include <vector>

#include "core/geometry/triangle_surface.hpp"
namespace tapstudy::core {
// A triangulated surface as the smooth one that it stands for, for force shading (Morgenbesser &
// Srinivasan 1996, Force shading for haptic shape perception): normals interpolated from the
// corners, as Phong did for light.
//
// A corner's normal is the mean of its triangles' normals, weighted by their angles there (Thürmer
// & Wüthrich 1998), over those that are joined by smooth edges: dihedral angle at most
// sharp_above_rad between two normals. Sharp edges stay sharp.
//
// Interpolating at the god-object alone would leave the steps of the god-object, which jumps where
// facets meet. So the foot of a point is sought instead: the place g on the triangles whose
// interpolated normal n points from the point p back to it,
//     p = g - d n(g) / |n(g)|,   d >= 0
// (Phong projection: Panozzo et al. 2013, Weighted averages on surfaces). Both g and n change
// continuously with p, within the radius of curvature of the surface.
//
// Built once; queries neither allocate nor throw.
class SmoothNormals {
 public:
  using Point = Eigen::Vector3d;
  using Points = TriangleSurface::Points;
  static constexpr double sharp_above_rad = std::numbers::pi / 6.0;
  struct Foot {
    int triangle{};
    std::array<double, 3> barycentric{};
    Point place_m{Point::Zero()};
    Point normal{Point::UnitZ()};  // unit length
    double depth_m{};
    bool is_at_sharp_edge{};  // the foot would lie beyond one; this is the place on it
  };

  // face_normals: unit length, a row per triangle.
  SmoothNormals(const TriangleSurface& surface, const Points& face_normals);

  // Whether the triangle has its own normal everywhere.
  bool is_flat(int triangle) const noexcept { return is_flat_[static_cast<std::size_t>(triangle)]; }
  // The foot of a point inside, sought from a triangle nearby; none beyond the radius of curvature.
  // The surface is the one that this was made of.
  std::optional<Foot> foot_of(const Point& inside_m, int nearby,
                              const TriangleSurface& surface) const noexcept;

 private:
  static constexpr int none = -1;
  using Corners = std::array<Point, 3>;

  void join_neighbours(const TriangleSurface& surface, const Points& face_normals);
  Point mean_around(const TriangleSurface& surface, const Points& face_normals, int triangle,
                    int corner) const;
  const Point& normal(int triangle, int corner) const noexcept {
    return normals_[static_cast<std::size_t>(3 * triangle + corner)];
  }
  int neighbour(int triangle, int edge) const noexcept {
    return neighbours_[static_cast<std::size_t>(3 * triangle + edge)];
  }
  // The edge to cross among those beyond which the barycentric coordinates lie; none if all are
  // sharp.
  int exit_edge(int triangle, const std::array<double, 3>& at) const noexcept;
  std::optional<Foot> foot_on(int triangle, const Point& inside_m,
                              const TriangleSurface& surface) const noexcept;
  void pull_to_edge(Foot& foot, const Point& inside_m,
                    const TriangleSurface& surface) const noexcept;

  // Three to a triangle. Edge i is opposite to corner i; its neighbour is none if it is sharp.
  std::vector<Point> normals_;
  std::vector<int> neighbours_;
  std::vector<bool> is_flat_;
};
}  // namespace tapstudy::core
