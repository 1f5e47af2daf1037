#include <array>

#include "core/error.hpp"
#include "core/model/elements/assembly.hpp"
#include "core/model/mesh/tetgen_mesher.hpp"
#include "core/model/modes/modal_solver.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
using namespace tapstudy;

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
