#pragma once
#include <Eigen/Core>
#include <array>
#include <map>
#include <set>
#include <vector>

#include "core/geometry/triangle_surface.hpp"
#include "core/haptics/haptic_state.hpp"
namespace tapstudy::core {
// The middle of a sheet: triangles that stand for a smooth surface, but for its folds: edges at
// which it turns by more than SmoothNormals::sharp_above_rad.
struct MiddleSurface {
  TriangleSurface facets;
  std::set<std::array<int, 2>> folds;  // ends ascending
};
MiddleSurface middle_surface(TriangleSurface facets);

// The smooth surface through the corners of the triangles: each a cubic Bézier triangle by the
// normals at its corners (Vlachos et al. 2001, Curved PN triangles), with folds and rims that are
// curves themselves where they turn smoothly, and handles as long as a circle's. Flat where the
// triangles are.
class CurvedTriangles {
 public:
  explicit CurvedTriangles(const MiddleSurface& surface);

  const MiddleSurface& surface() const { return surface_; }
  // From the shares of the second and the third corner.
  Vec3 at_m(Eigen::Index triangle, double x, double y) const;
  // Triangles that follow one another round a point over smooth edges are one fan.
  int fan(Eigen::Index triangle, int corner) const {
    return fans_[static_cast<std::size_t>(3 * triangle + corner)];
  }
  bool is_smooth(int from, int to) const;  // an edge, as one of its triangles has it

 private:
  Vec3 point_m(int number) const { return surface_.facets.points_m.row(number); }
  int corner(Eigen::Index triangle, int k) const { return surface_.facets.triangles(triangle, k); }
  void join_fans();
  void find_rims();
  Vec3 mean_normal(int fan) const;
  Vec3 fitted_normal(int fan) const;
  std::set<int> points_near(int fan) const;
  Vec3 tangent_on_rim(int from, int to) const;
  Vec3 control_m(Eigen::Index triangle, int from, int to) const;
  std::array<Vec3, 10> controls_of(Eigen::Index triangle) const;

  const MiddleSurface& surface_;
  std::map<std::array<int, 2>, int> triangle_of_edge_;    // by its ends, as the triangle has them
  std::vector<int> fans_;                                 // three to a triangle
  std::vector<std::vector<std::array<int, 2>>> members_;  // of each fan: triangle, corner
  std::vector<Vec3> normals_;                             // of each fan
  std::map<int, Vec3> tangents_;                          // of rims and folds, where smooth
  std::vector<std::array<Vec3, 10>> controls_m_;
};

// What is within `rounding_m` of a box along the axes, to be filled with nodes: a ball is a point
// rounded by its radius.
struct FilledRegion {
  Vec3 low_m;
  Vec3 high_m;
  double rounding_m{};
  double width_m{};  // twice its area in a plane over its perimeter there: of a ball its radius
};
// Triangles divided until no edge is longer, nor longer than half of a region's width within it,
// and little by little more around it, so that the nodes in the region fill it; the smooth surface
// stays, but for what cubic patches approximate. Throws ModelError beyond `most` triangles.
MiddleSurface divided(MiddleSurface surface, double longest_m,
                      const std::vector<FilledRegion>& regions, Eigen::Index most);
}  // namespace tapstudy::core
