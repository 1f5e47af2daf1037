#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/elements/spring_support.hpp"
#include "core/model/mesh/tet_mesh.hpp"
#include "core/model/shape/shape.hpp"
namespace tapstudy::core {
// Which of a plate's nodes a vertex or disc selects: those on the tapped face, on the face below,
// on both (a screw clamping the plate), or through the whole thickness (a through bolt).
enum class Face { top, bottom, both, through };
// The faces of a body's bounding box: left is low x, front low y, bottom low z.
enum class Side { left, right, front, back, bottom, top };
enum class RegionShape { vertex, disc, ball, box, side };
// Their names in protocols, in the order of the enumerations.
inline constexpr std::array<std::string_view, 4> face_names{"top", "bottom", "both", "through"};
inline constexpr std::array<std::string_view, 6> side_names{"left", "right",  "front",
                                                            "back", "bottom", "top"};
inline constexpr std::array<std::string_view, 5> region_names{"vertex", "disc", "ball", "box",
                                                              "side"};
static_assert(face_names.size() == static_cast<std::size_t>(Face::through) + 1);
static_assert(side_names.size() == static_cast<std::size_t>(Side::top) + 1);
static_assert(region_names.size() == static_cast<std::size_t>(RegionShape::side) + 1);
template <class Enumeration, std::size_t Size>
constexpr std::string_view name_in(const std::array<std::string_view, Size>& names,
                                   Enumeration value) {
  return names.at(static_cast<std::size_t>(value));
}

// A boundary condition of the finite element model: a region of the body whose displacement is zero
// along the constrained axes (a homogeneous Dirichlet condition), or that springs hold to the
// ground (a Robin condition).
//   vertex  a single node, as in the paper; under mesh refinement its frequencies never settle,
//           because a point cannot hold a solid
//   disc    of a plate: a screw's head, round at_m on its faces; does settle
//   ball    what lies within a radius of a point
//   box     what lies between two corners
//   side    all that touches one side of the bounding box
struct Fixation {
  RegionShape shape{RegionShape::vertex};
  Vec3 at_m{Vec3::Zero()};                                 // vertex, disc (z unused), ball
  double radius_m{0.0};                                    // disc, ball
  Face face{Face::both};                                   // vertex and disc of a plate
  Vec3 low_m{Vec3::Zero()};                                // box
  Vec3 high_m{Vec3::Zero()};                               // box
  Side side{Side::left};                                   // side
  std::array<bool, 3> constrained_axes{true, true, true};  // x y z
  // Instead of constraints: of the whole region, along x y z; 0: free along that axis.
  std::optional<Vec3> springs_n_per_m{};
};

// The points that a box's mesh must contain as nodes so that every fixation selects some:
// vertices, a disc's centre and eight points on its rim, the corners of a box region, where they
// lie on the plate. Surfaces from files keep their own points.
std::vector<Vec3> points_to_mesh(const std::vector<Fixation>& fixations, const Shape& shape);

// The nodes that the fixation holds. Throws ModelError, naming `whose` region it is, if there are
// none.
std::vector<Eigen::Index> nodes_of(const Fixation& fixation, const TetMesh& mesh,
                                   const Shape& shape, std::string_view whose = "fixation");

// The same nodes, with the part of the surface that the region takes up.
SurfaceRegion region_of(const Fixation& fixation, const TetMesh& mesh, const Shape& shape);

// The constraints that the fixations put on a mesh. One flag a degree of freedom (x0 y0 z0 x1 …):
// true where it is constrained.
// Throws ModelError if a fixation touches no node or if nothing is left free.
std::vector<bool> constrained_dofs(const TetMesh& mesh, const Shape& shape,
                                   const std::vector<Fixation>& fixations);

// The springs among the fixations. Throws ModelError as nodes_of.
std::vector<SpringSupport> spring_supports(const TetMesh& mesh, const Shape& shape,
                                           const std::vector<Fixation>& fixations);
bool is_on_springs(const std::vector<Fixation>& fixations);

// False for points and lines: the frequencies of a solid held by them fall without end as its mesh
// is refined.
bool can_hold_a_solid(const Fixation& fixation);

// The area of the surface triangles that each fixation holds whole, or, where it holds none, of a
// cube as large as the tetrahedra that it holds [m²].
std::vector<double> held_areas_m2(const TetMesh& mesh, const Shape& shape,
                                  const std::vector<Fixation>& fixations);

// A sentence for each rigid fixation whose nodes span clearly less than what it takes up of the
// surface: its frequencies are those of a smaller one. None for points, lines and sides.
std::vector<std::string> held_in_part(const TetMesh& mesh, const Shape& shape,
                                      const std::vector<Fixation>& fixations);

// Equal text for equal fixations.
std::string content_key(const Fixation& fixation);
}  // namespace tapstudy::core
