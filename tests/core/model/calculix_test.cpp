// The same meshes and constraints through CalculiX (Dhondt), which shares no code with us.
#include "support/calculix.hpp"

#include <cmath>
#include <fstream>
#include <numbers>

#include "core/model/elements/assembly.hpp"
#include "core/model/mesh/tetgen_mesher.hpp"
#include "core/model/modes/modal_solver.hpp"
#include "core/model/plate_model.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
#include "support/surfaces.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
testing::CalculixInput input(const core::PlateSpec& spec, const core::TetMesh& mesh) {
  testing::CalculixInput text;
  text.add_body(spec, spec.material, mesh);
  return text;
}

// "row column value" a line, one of the triangles, in CalculiX's order of degrees of freedom.
core::SparseMatrix read_matrix(const std::string& path, const std::vector<int>& ours) {
  std::ifstream file{path};
  std::vector<Eigen::Triplet<double>> entries;
  std::size_t row{};
  std::size_t column{};
  for (double value{}; file >> row >> column >> value;) {
    const auto [low, high] = std::minmax(ours.at(row - 1), ours.at(column - 1));
    entries.emplace_back(high, low, value);
  }
  core::SparseMatrix matrix(static_cast<int>(ours.size()), static_cast<int>(ours.size()));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// CalculiX's own matrices, in our order.
core::StiffnessAndMass calculix_matrices(const core::PlateSpec& spec, const core::TetMesh& mesh,
                                         const core::FreeDofs& dofs) {
  const testing::TempDirectory directory;
  testing::run_calculix(input(spec, mesh).with_step("*FREQUENCY, SOLVER=MATRIXSTORAGE"), directory);
  std::ifstream order{directory / "body.dof"};  // "node.axis" a line
  std::vector<int> ours;
  std::size_t node{};
  std::size_t axis{};
  for (char dot{}; order >> node >> dot >> axis;) {
    ours.push_back(dofs.position.at(3 * (node - 1) + axis - 1));
  }
  REQUIRE(static_cast<int>(ours.size()) == dofs.count);
  return {read_matrix(directory / "body.sti", ours), read_matrix(directory / "body.mas", ours)};
}

core::PlateSpec with_shape(core::Shape shape, double tet_volume_m3, double band_hz) {
  core::PlateSpec spec{{std::move(shape), {}, {}}, testing::acrylic(), band_hz};
  spec.mesh.order = 2;
  spec.mesh.size.max_tet_volume_m3 = tet_volume_m3;
  return spec;
}
core::Fixation side(core::Side which, std::array<bool, 3> axes) {
  core::Fixation fixation;
  fixation.shape = core::RegionShape::side;
  fixation.side = which;
  fixation.constrained_axes = axes;
  return fixation;
}
core::Fixation ball(const core::Vec3& at_m, double radius_m) {
  core::Fixation fixation;
  fixation.shape = core::RegionShape::ball;
  fixation.at_m = at_m;
  fixation.radius_m = radius_m;
  return fixation;
}
// Coarse meshes, and bands up to where a wavelength is but a few of their elements.
std::vector<core::PlateSpec> coarse_bodies() {
  core::PlateSpec plate = testing::paper_plate(4, testing::mdf());
  plate.mesh.order = 2;
  core::PlateSpec block = with_shape(core::Solid{testing::notched_block()}, 5e-5, 4000.0);
  block.fixations = {side(core::Side::bottom, {true, true, true})};
  core::PlateSpec sphere = with_shape(core::Solid{testing::sphere_surface(0.1, 8)}, 5e-5, 6000.0);
  sphere.fixations = {ball({0.0, 0.0, -0.1}, 0.03)};
  core::PlateSpec sliding = with_shape(core::Box{{0.3, 0.2, 0.02}}, 5e-6, 2000.0);
  sliding.fixations = {side(core::Side::left, {false, false, true}), ball({0.15, 0.1, 0.0}, 0.01)};
  return {plate, block, sphere, sliding};
}
}  // namespace

TEST_CASE("CalculiX finds the same frequencies on the same mesh", "[core][model][calculix][slow]") {
  std::vector<core::PlateSpec> bodies = coarse_bodies();
  bodies[1].mesh.size.max_tet_volume_m3 = 4e-6;
  bodies[2].mesh.size.max_tet_volume_m3 = 2e-6;
  bodies[2].band_limit_hz = 4300.0;
  bodies[3].mesh.size.max_tet_volume_m3 = 1e-6;
  bodies[3].band_limit_hz = 1800.0;
  bodies.push_back(bodies[0]);
  for (core::Fixation& corner : bodies.back().fixations) {
    corner.springs_n_per_m = core::Vec3{2e5, 3e5, 1e6};
  }
  for (const core::PlateSpec& spec : bodies) {
    const core::PlateModel ours = core::build_plate_model(spec);
    const auto count = static_cast<int>(ours.modal.frequency_hz.size());
    REQUIRE(count >= 3);
    const std::vector<double> theirs = testing::calculix_hz(input(spec, ours.body.mesh), count);
    REQUIRE(static_cast<int>(theirs.size()) == count);
    for (int i = 0; i < count; ++i) {
      CAPTURE(i, ours.modal.frequency_hz[i], theirs[static_cast<std::size_t>(i)]);
      CHECK(std::abs(ours.modal.frequency_hz[i] / theirs[static_cast<std::size_t>(i)] - 1.0) <
            1e-4);
    }
  }
}

// CalculiX sums the mass of a C3D10 over the four points that are exact for its stiffness; we
// integrate it exactly, and the frequencies part where elements are coarse for the mode.
TEST_CASE("CalculiX forms the same stiffness, and its matrices give us its frequencies",
          "[core][model][calculix][slow]") {
  for (const core::PlateSpec& spec : coarse_bodies()) {
    const core::SolvedBody body = core::solve_body(core::body_of(spec));
    const auto dofs =
        core::free_dofs(core::constrained_dofs(body.mesh, spec.shape, spec.fixations));
    const core::StiffnessAndMass ours = core::assemble(body.mesh, spec.material, dofs);
    const core::StiffnessAndMass theirs = calculix_matrices(spec, body.mesh, dofs);
    CHECK((ours.K - theirs.K).norm() < 1e-9 * ours.K.norm());
    const core::Modes modes = core::solve_modes(theirs, spec.band_limit_hz);
    const auto count = static_cast<int>(modes.omega_rad_s.size());
    REQUIRE(count >= 3);
    const std::vector<double> hz = testing::calculix_hz(input(spec, body.mesh), count);
    for (int i = 0; i < count; ++i) {
      const double found_hz = modes.omega_rad_s[i] / (2.0 * std::numbers::pi);
      CAPTURE(i, found_hz, hz[static_cast<std::size_t>(i)]);
      CHECK(std::abs(found_hz / hz[static_cast<std::size_t>(i)] - 1.0) < 1e-6);
    }
  }
}
