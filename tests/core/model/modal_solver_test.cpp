#include "core/model/modes/modal_solver.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/error.hpp"
#include "core/model/mesh/tetgen_mesher.hpp"
#include "core/model/modes/shifted_factor.hpp"
#include "core/model/plate_model.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
using namespace tapstudy;
using core::StiffnessAndMass;

namespace {
StiffnessAndMass assembled(const core::PlateSpec& plate) {
  const core::TetMesh mesh = core::mesh_shape(plate.shape, plate.mesh.size,
                                              core::points_to_mesh(plate.fixations, plate.shape));
  return core::assemble(
      mesh, plate.material,
      core::free_dofs(core::constrained_dofs(mesh, plate.shape, plate.fixations)));
}
// All eigenvalues by a dense solver that shares nothing with the sparse one.
Eigen::VectorXd all_eigenvalues(const StiffnessAndMass& matrices) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>{
      Eigen::MatrixXd{matrices.K}, Eigen::MatrixXd{matrices.M}, Eigen::EigenvaluesOnly}
      .eigenvalues();
}
// A bar of 1 × 0.05 × 0.05 m, every node of its end face held.
double cantilever_hz(double max_tet_volume_m3) {
  const core::Box bar{{1.0, 0.05, 0.05}};
  core::MeshSize size;
  size.max_tet_volume_m3 = max_tet_volume_m3;
  const core::TetMesh mesh = core::mesh_shape(bar, size);
  std::vector<bool> held;
  for (const double x : mesh.nodes_m.col(0)) {
    held.insert(held.end(), 3, x < bar.low_m().x() + 1e-9);
  }
  const core::Modes modes =
      core::solve_modes(core::assemble(mesh, testing::mdf(), core::free_dofs(held)), 100.0);
  return modes.omega_rad_s[0] / (2.0 * M_PI);
}
}  // namespace

TEST_CASE("the assembled mass is the plate's mass along each axis", "[core][model]") {
  core::PlateSpec plate = testing::paper_plate(2, testing::mdf());
  plate.fixations.clear();
  const StiffnessAndMass matrices = assembled(plate);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::VectorXd shift = Eigen::Vector3d::Unit(axis).replicate(matrices.M.rows() / 3, 1);
    CHECK(shift.dot(matrices.mass() * shift) == Approx(0.6 * 0.6 * 0.05 * 610.0));
    CHECK((matrices.stiffness() * shift).norm() < 1e-9 * matrices.K.norm());
  }
}

TEST_CASE("the inertia of K - sigma M counts the eigenvalues below sigma", "[core][model]") {
  const StiffnessAndMass matrices = assembled(testing::paper_plate(2, testing::acrylic()));
  const Eigen::VectorXd eigenvalues = all_eigenvalues(matrices);
  for (const double hz : {10.0, 60.0, 210.0, 300.0, 1000.0, 3000.0}) {
    const double sigma = std::pow(2.0 * M_PI * hz, 2);
    CHECK(core::ShiftedFactor(matrices, sigma).eigenvalues_below() ==
          (eigenvalues.array() < sigma).count());
  }
}

TEST_CASE("all modes of the band are found, none beyond, M-orthonormal", "[core][model]") {
  const double band_hz = GENERATE(50.0, 300.0, 2000.0);
  const StiffnessAndMass matrices = assembled(testing::paper_plate(4, testing::mdf()));
  const Eigen::VectorXd eigenvalues = all_eigenvalues(matrices);
  const core::Modes modes = core::solve_modes(matrices, band_hz);
  const double limit = std::pow(2.0 * M_PI * band_hz, 2);
  REQUIRE(modes.omega_rad_s.size() == (eigenvalues.array() < limit).count());
  for (Eigen::Index i = 0; i < modes.omega_rad_s.size(); ++i) {
    CHECK(std::pow(modes.omega_rad_s[i], 2) == Approx(eigenvalues[i]).epsilon(1e-9));
  }
  const Eigen::MatrixXd gram = modes.shapes.transpose() * (matrices.mass() * modes.shapes);
  CHECK((gram - Eigen::MatrixXd::Identity(gram.rows(), gram.cols())).cwiseAbs().sum() < 1e-9);
}

TEST_CASE("a free plate has six motions of the rigid body, left out and reported",
          "[core][model]") {
  core::PlateSpec plate = testing::paper_plate(2, testing::mdf());
  plate.fixations.clear();
  const core::Modes modes = core::solve_modes(assembled(plate), 1000.0);
  CHECK(modes.rigid_body_modes == 6);
  CHECK(modes.counted_in_band == 6 + modes.omega_rad_s.size());
  REQUIRE(modes.omega_rad_s.size() > 0);
  CHECK(modes.omega_rad_s[0] > 2.0 * M_PI * 10.0);
}

TEST_CASE("frequencies scale with the root of stiffness over density", "[core][model]") {
  core::PlateSpec plate = testing::paper_plate(3, testing::mdf());
  const auto soft = core::build_plate_model(plate);
  plate.material.youngs_modulus_pa *= 4.0;
  plate.band_limit_hz *= 2.0;
  const auto stiff = core::build_plate_model(plate);
  REQUIRE(stiff.modal.frequency_hz.size() == soft.modal.frequency_hz.size());
  CHECK((stiff.modal.frequency_hz / soft.modal.frequency_hz - 2.0).abs().maxCoeff() < 1e-9);
}

// Euler-Bernoulli: f = 1.8751² / (2 pi) sqrt(E I / (rho A L⁴)), 16.35 Hz for this bar; shear and
// rotary inertia take 0.2 % off, a held Poisson contraction adds as much. Linear tetrahedra are too
// stiff in bending and come down to it from above.
TEST_CASE("a slender cantilever comes down to Euler-Bernoulli as far as T4 allows",
          "[core][model][slow]") {
  const double exact_hz =
      1.8751041 * 1.8751041 / (2.0 * M_PI) * std::sqrt(2.5e9 * 0.05 * 0.05 / 12.0 / 610.0);
  const double coarse = cantilever_hz(4e-6) / exact_hz - 1.0;
  const double medium = cantilever_hz(1e-6) / exact_hz - 1.0;
  const double fine = cantilever_hz(1.2e-7) / exact_hz - 1.0;
  CAPTURE(coarse, medium, fine);
  CHECK(coarse > medium);
  CHECK(medium > fine);
  CHECK(fine > 0.0);
  CHECK(coarse < 0.25);
  CHECK(medium < 0.12);
  CHECK(fine < 0.035);
}

TEST_CASE("a body of a few nodes is solved as well", "[core][model]") {
  core::PlateSpec cube = testing::paper_plate(4, testing::mdf());
  cube.shape = core::Box{{0.1, 0.1, 0.1}};
  for (core::Fixation& corner : cube.fixations) {
    corner.at_m /= 6.0;
    corner.face = core::Face::bottom;
  }
  cube.band_limit_hz = 20000.0;
  CHECK(core::build_plate_model(cube).modal.frequency_hz.size() > 0);
}

TEST_CASE("only motions that nothing holds are of the rigid body, however soft the body",
          "[core][model]") {
  core::PlateSpec plate = testing::paper_plate(4, testing::mdf());
  const auto rigid = [&] { return core::solve_body(core::body_of(plate)).modes.report; };
  CHECK(rigid().rigid_body_modes == 0);
  plate.material.youngs_modulus_pa = 1e3;  // all far below the band
  plate.band_limit_hz = 20.0;
  CHECK(rigid().rigid_body_modes == 0);
  plate.fixations.resize(1);  // pinched at one point of each face: it turns about the line between
  CHECK(rigid().rigid_body_modes == 1);
  plate.fixations[0].face = core::Face::top;  // at one point it turns about three axes
  CHECK(rigid().rigid_body_modes == 3);
  plate.fixations[0].constrained_axes = {false, false, true};
  CHECK(rigid().rigid_body_modes == 5);
  plate.fixations.clear();
  CHECK(rigid().rigid_body_modes == 6);
}

TEST_CASE("hundreds of modes of a soft body all swing as K x = w^2 M x says",
          "[core][model][slow]") {
  core::Material rubber = testing::mdf();
  rubber.youngs_modulus_pa = 1e6;
  core::PlateSpec plate = testing::paper_plate(3, rubber);
  plate.mesh.size.max_tet_volume_m3 = 1.8e-5;
  for (core::Fixation& fixation : plate.fixations) {
    fixation.shape = core::RegionShape::disc;
    fixation.radius_m = 0.04;
  }
  const core::Modes modes = core::solve_modes(assembled(plate), 300.0);
  CHECK(modes.omega_rad_s.size() > 300);
  CHECK(modes.omega_rad_s.size() == modes.counted_in_band);
  CHECK(modes.worst_residual < 2e-8);
}

TEST_CASE("the same body is solved to the same last bit every time", "[core][model][slow]") {
  core::PlateSpec plate = testing::paper_plate(4, testing::mdf());
  plate.mesh.order = 2;
  plate.mesh.size.max_tet_volume_m3 = 1.5e-5;
  const core::SolvedBody first = core::solve_body(core::body_of(plate));
  for (int again = 0; again < 3; ++again) {
    const core::SolvedBody second = core::solve_body(core::body_of(plate));
    CHECK((second.modes.kappa_rad_per_m == first.modes.kappa_rad_per_m).all());
    CHECK((second.displacement.array() == first.displacement.array()).all());
  }
}
