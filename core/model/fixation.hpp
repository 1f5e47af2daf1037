#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "core/model/box.hpp"
#include "core/model/tet_mesh.hpp"
namespace tapstudy::core {
// Which of a region's nodes are meant: those on the tapped face, on the face below, on both (a
// screw that pinches the plate), or everything in between as well (a bolt through it).
enum class Face { top, bottom, both, through };
enum class RegionShape { vertex, disc };

// A region of the plate that does not move along the held axes. A vertex holds single nodes, as the
// paper does; under mesh refinement its frequencies never settle, because a point cannot hold a
// solid. A disc (a screw's head) does settle.
struct Fixation {
  RegionShape shape{RegionShape::vertex};
  Eigen::Vector2d at_m{Eigen::Vector2d::Zero()};  // plate frame, sideways
  double radius_m{0.0};                           // of a disc
  Face face{Face::both};
  std::array<bool, 3> holds{true, true, true};  // x y z
};

// The points that a mesh must have as nodes for the fixations to find something to hold: the
// vertices, and for a disc its centre and eight points on its rim, where they lie on the plate.
std::vector<Vec3> points_to_mesh(const std::vector<Fixation>& fixations, const Box& box);

// One flag a degree of freedom (x0 y0 z0 x1 …): true where it is held.
// Throws ModelError if a fixation touches no node or if nothing is left free.
std::vector<bool> held_dofs(const TetMesh& mesh, const Box& box,
                            const std::vector<Fixation>& fixations);
}  // namespace tapstudy::core
