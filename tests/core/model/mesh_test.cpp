#include <map>

#include "core/error.hpp"
#include "core/model/fixation.hpp"
#include "core/model/mesh/tetgen_mesher.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using core::Box;

namespace {
const Box plate{{0.6, 0.6, 0.05}};
bool has_node(const core::TetMesh& mesh, const core::Vec3& at_m) {
  return (mesh.nodes_m.rowwise() - at_m.transpose()).rowwise().norm().minCoeff() < 1e-9;
}
core::Fixation disc(double x, double y, double radius, core::Face face) {
  core::Fixation fixation;
  fixation.shape = core::RegionShape::disc;
  fixation.at_m = {x, y, 0.0};
  fixation.radius_m = radius;
  fixation.face = face;
  return fixation;
}
}  // namespace

TEST_CASE("a meshed box has the box's volume and a closed surface", "[core][mesh]") {
  const auto size = GENERATE(values<core::Vec3>(
      {{0.6, 0.6, 0.05}, {1.0, 0.05, 0.05}, {0.1, 0.2, 0.3}, {600.0, 600.0, 50.0}}));
  const Box box{size};
  const core::TetMesh mesh = core::mesh_shape(box, {});
  CHECK(core::volume_m3(mesh) == Approx(size.prod()));
  std::map<std::pair<int, int>, int> edges;
  for (const auto& triangle : mesh.surface.rowwise()) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      ++edges[{triangle[i], triangle[(i + 1) % 3]}];
    }
  }
  for (const auto& [edge, count] : edges) {
    CHECK(count == 1);
    CHECK(edges.count({edge.second, edge.first}) == 1);
  }
}

TEST_CASE("a smaller tetrahedron limit is kept", "[core][mesh]") {
  core::MeshSize fine;
  fine.max_tet_volume_m3 = 1e-5;
  const core::TetMesh mesh = core::mesh_shape(plate, fine);
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    CHECK(core::tet_volume_m3(mesh, tet) <= 1e-5 * (1.0 + 1e-9));
  }
}

TEST_CASE("fixations find their nodes on faces, edges and corners", "[core][mesh][fixation]") {
  const std::vector<core::Fixation> fixations{disc(0.1, -0.05, 0.01, core::Face::both),
                                              disc(0.3, 0.0, 0.02, core::Face::top),
                                              disc(-0.3, -0.3, 0.01, core::Face::through)};
  const auto points = core::points_to_mesh(fixations, plate);
  const core::TetMesh mesh = core::mesh_shape(plate, {}, points);
  for (const core::Vec3& point : points) {
    CHECK(has_node(mesh, point));
  }
  CHECK(core::volume_m3(mesh) == Approx(0.6 * 0.6 * 0.05));
  const auto held = core::constrained_dofs(mesh, plate, fixations);
  // nine on each face, six on half a disc, and those of the quarter disc
  CHECK(std::count(held.begin(), held.end(), true) >= 3 * (18 + 6 + 8));
}

TEST_CASE("a fixation holds just the axes it says", "[core][fixation]") {
  core::Fixation slider = disc(0.0, 0.0, 0.02, core::Face::top);
  slider.constrained_axes = {false, false, true};
  const core::TetMesh mesh = core::mesh_shape(plate, {}, core::points_to_mesh({slider}, plate));
  const auto held = core::constrained_dofs(mesh, plate, {slider});
  for (std::size_t dof = 0; dof < held.size(); ++dof) {
    CHECK((!held[dof] || dof % 3 == 2));
  }
  CHECK(std::count(held.begin(), held.end(), true) >= 9);
}

TEST_CASE("a fixation off the plate, or one that holds everything, is refused",
          "[core][fixation]") {
  const core::TetMesh mesh = core::mesh_shape(plate, {});
  CHECK_THROWS_WITH(core::constrained_dofs(mesh, plate, {disc(2.0, 0.0, 0.1, core::Face::top)}),
                    Contains("touches no node"));
  CHECK_THROWS_WITH(core::constrained_dofs(mesh, plate, {disc(0.0, 0.0, 9.0, core::Face::through)}),
                    Contains("nothing is left free"));
}

TEST_CASE("a sheet that would take millions of tetrahedra is refused", "[core][mesh]") {
  CHECK_THROWS_WITH(core::mesh_shape(Box{{0.6, 0.6, 0.0005}}, {}), Contains("too thin"));
  core::MeshSize tiny;
  tiny.max_tet_volume_m3 = 1e-12;
  CHECK_THROWS_WITH(core::mesh_shape(plate, tiny), Contains("max_tet_volume_m3"));
}

TEST_CASE("a mesh is written in TetGen's form and never over a file", "[core][mesh]") {
  const testing::TempDirectory directory;
  const core::TetMesh mesh = core::mesh_shape(plate, {});
  core::write_tetgen_files(mesh, directory / "plate");
  CHECK_THAT(testing::contents(directory / "plate.node"),
             Catch::Matchers::StartsWith("172 3 0 0\n"));
  CHECK_THAT(testing::contents(directory / "plate.ele"), Catch::Matchers::StartsWith("445 4 0\n"));
  CHECK_THROWS_AS(core::write_tetgen_files(mesh, directory / "plate"), core::InvalidInput);
}
