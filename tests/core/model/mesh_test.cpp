#include <array>
#include <map>

#include "core/error.hpp"
#include "core/model/element_order.hpp"
#include "core/model/elements/assembly.hpp"
#include "core/model/fixation.hpp"
#include "core/model/mesh/tetgen_mesher.hpp"
#include "core/model/mesh/wanted_order.hpp"
#include "core/model/modes/modal_solver.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
#include "support/sharp_fins.hpp"
#include "support/surfaces.hpp"
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

namespace {
constexpr std::array<std::array<int, 3>, 12> faces_of_cube{{{0, 2, 3},
                                                            {0, 3, 1},
                                                            {4, 5, 7},
                                                            {4, 7, 6},
                                                            {0, 1, 5},
                                                            {0, 5, 4},
                                                            {2, 6, 7},
                                                            {2, 7, 3},
                                                            {0, 4, 6},
                                                            {0, 6, 2},
                                                            {1, 3, 7},
                                                            {1, 7, 5}}};

// A cube of 0.1 m cut by one node inside, which lies so high above the middle of the bottom, on the
// edge between its two triangles: the two tetrahedra there are slivers.
core::TetMesh cube_with_slivers(double height_m) {
  core::TetMesh mesh;
  mesh.nodes_m.resize(9, 3);
  for (int corner = 0; corner < 8; ++corner) {
    mesh.nodes_m.row(corner) << 0.1 * (corner % 2), 0.1 * (corner / 2 % 2), 0.1 * (corner / 4);
  }
  mesh.nodes_m.row(8) << 0.05, 0.05, height_m;
  mesh.tets.resize(12, 4);
  mesh.surface.resize(12, 3);
  for (Eigen::Index i = 0; i < 12; ++i) {
    const auto& face = faces_of_cube.at(static_cast<std::size_t>(i));
    mesh.surface.row(i) << face[0], face[1], face[2];
    mesh.tets.row(i) << face[0], face[2], face[1], 8;
  }
  return core::to_quadratic(mesh);
}

core::Modes modes_of_free(const core::TetMesh& mesh) {
  core::StiffnessAndMass matrices = core::assemble(
      mesh, testing::acrylic(),
      core::free_dofs(std::vector<bool>(static_cast<std::size_t>(mesh.nodes_m.size()), false)));
  matrices.rigid_body_modes = 6;
  return core::solve_modes(matrices, 15000.0);
}
}  // namespace

TEST_CASE("slivers make a body stiffer or are refused, but never spoil its modes",
          "[core][model]") {
  core::MeshSize fine;
  fine.max_tet_volume_m3 = 1e-3 / 1500.0;
  const core::Modes truth =
      modes_of_free(core::to_quadratic(core::mesh_shape(core::Box{{0.1, 0.1, 0.1}}, fine)));
  REQUIRE(truth.omega_rad_s.size() >= 3);
  for (const double height_m : {5e-2, 1e-3, 1e-5, 1e-7, 1e-9, 1e-12, 1e-16, 0.0}) {
    CAPTURE(height_m);
    const core::TetMesh mesh = cube_with_slivers(height_m);
    try {
      const core::Modes modes = modes_of_free(mesh);
      CHECK(modes.rigid_body_modes == 6);
      CHECK(modes.worst_residual < 1e-6);
      REQUIRE(modes.omega_rad_s.size() <= truth.omega_rad_s.size());
      for (Eigen::Index i = 0; i < modes.omega_rad_s.size(); ++i) {
        CHECK(modes.omega_rad_s[i] > 0.999 * truth.omega_rad_s[i]);
      }
    } catch (const core::ModelError& refusal) {
      CAPTURE(refusal.what());
      CHECK(height_m < 1e-6);
      CHECK_THAT(refusal.what(), Contains("flat") || Contains("no volume"));
    }
  }
}

TEST_CASE(
    "where the bound asked for takes too many elements, a surface is meshed with the next, and "
    "told",
    "[core][mesh][slow]") {
  const core::Shape ball = core::Solid{testing::sphere_surface(0.05, 30)};
  core::MeshSize size;
  size.radius_edge_ratio = 1.1;  // with which TetGen does not end near the poles
  const core::TetMesh mesh = core::mesh_shape(ball, size);
  CHECK(mesh.radius_edge_ratio.asked == 1.1);
  CHECK(mesh.radius_edge_ratio.used == 2.0);
  CHECK(core::to_quadratic(mesh).radius_edge_ratio.is_relaxed());
  CHECK(core::volume_m3(mesh) == Approx(core::volume_m3(ball)).epsilon(1e-9));
  const core::RadiusEdgeRatio usual = core::mesh_shape(ball, {}).radius_edge_ratio;
  CHECK(usual.asked == core::MeshSize{}.radius_edge_ratio);
  CHECK_FALSE(usual.is_relaxed());
}

TEST_CASE("a surface has the smallest ratio with which quadratic elements are few enough",
          "[core][mesh][slow]") {
  const core::Shape finned = core::Solid{testing::sharp_fins(1, 2e-5)};
  const core::TetMesh mesh =
      core::mesh_shape(finned, {}, {}, core::WantedOrder::quadratic_if_small);
  CHECK(mesh.radius_edge_ratio.used == 8.0);
  CHECK(3 * core::to_quadratic(mesh).nodes_m.rows() <= core::max_chosen_dofs);
  CHECK(core::volume_m3(mesh) == Approx(core::volume_m3(finned)).epsilon(1e-9));
}
