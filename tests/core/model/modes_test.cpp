#include <cmath>
#include <fstream>
#include <numbers>

#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
#include "core/model/elements/assembly.hpp"
#include "core/model/elements/material.hpp"
#include "core/model/mesh/tetgen_mesher.hpp"
#include "core/model/modes/damping.hpp"
#include "core/model/modes/modal_solver.hpp"
#include "core/model/modes/shifted_factor.hpp"
#include "core/model/plate_model.hpp"
#include "support/calculix.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
#include "support/surfaces.hpp"
#include "support/texts.hpp"
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
// All eigenvalues by LAPACK's dense solver, which shares nothing with the sparse one.
Eigen::VectorXd all_eigenvalues(const StiffnessAndMass& matrices) {
  return core::symmetric_eigenpairs(Eigen::MatrixXd{matrices.K}, Eigen::MatrixXd{matrices.M})
      .values;
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

TEST_CASE("a body of some dozens of nodes has its modes in any band", "[core][model]") {
  core::PlateSpec block = testing::paper_plate(0, testing::mdf());
  block.shape = core::Box{{0.3, 0.2, 0.05}};
  block.mesh.size.max_tet_volume_m3 = 1.0;
  const StiffnessAndMass matrices = assembled(block);
  REQUIRE(matrices.K.rows() == 99);  // too many for the least basis, too few for a large one
  const Eigen::VectorXd eigenvalues = all_eigenvalues(matrices);
  for (const double hz : {3000.0, 4000.0, 5000.0, 6000.0, 8000.0, 10000.0, 13000.0}) {
    CAPTURE(hz);
    const auto below = (eigenvalues.array() < std::pow(2.0 * M_PI * hz, 2)).count();
    const core::Modes modes = core::solve_modes(matrices, hz);
    REQUIRE(modes.omega_rad_s.size() == below - 6);
    CHECK(modes.omega_rad_s.square().isApprox(eigenvalues.segment(6, below - 6).array(), 1e-9));
  }
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

// The same meshes and constraints through CalculiX (Dhondt), which shares no code with us.
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
  core::PlateSpec wooden = with_shape(core::Box{{0.3, 0.2, 0.02}}, 5e-6, 700.0);
  wooden.fixations = {side(core::Side::left, {true, true, true})};
  wooden.material = {1.1e10, 420.0, 0.0, core::ConstantDamping{0.01}};
  wooden.material.orthotropy = core::Orthotropy{
      {1.0, 0.07, 0.04}, {0.37, 0.42, 0.47}, {0.06, 0.055, 0.0035}, {0.3, -0.2, 0.5}};
  return {plate, block, sphere, sliding, wooden};
}
}  // namespace

TEST_CASE("CalculiX finds the same frequencies on the same mesh", "[core][model][calculix][slow]") {
  std::vector<core::PlateSpec> bodies = coarse_bodies();
  bodies[1].mesh.size.max_tet_volume_m3 = 4e-6;
  bodies[2].mesh.size.max_tet_volume_m3 = 2e-6;
  bodies[2].band_limit_hz = 4300.0;
  bodies[3].mesh.size.max_tet_volume_m3 = 1e-6;
  bodies[3].band_limit_hz = 1800.0;
  bodies[4].mesh.size.max_tet_volume_m3 = 1e-6;
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

TEST_CASE("two ratios put through eq. 13 come back out of eq. 12", "[core][damping]") {
  const core::TwoRatioDamping wanted{0.17, 0.09};
  const Eigen::ArrayXd omega = Eigen::Array3d{360.0, 900.0, 1560.0};
  const core::RayleighDamping found = core::rayleigh_from_two_ratios(wanted, 360.0, 1560.0);
  const Eigen::ArrayXd ratios = core::damping_ratios(found, omega);
  CHECK(ratios[0] == Approx(0.17));
  CHECK(ratios[2] == Approx(0.09));
}

TEST_CASE("ratios that would feed energy into a mode are refused", "[core][damping]") {
  CHECK_THROWS_WITH(core::rayleigh_from_two_ratios({0.5, 0.01}, 100.0, 1000.0),
                    Contains("would gain energy"));
  CHECK_THROWS_AS(core::rayleigh_from_two_ratios({0.1, 0.1}, 500.0, 500.0), core::ModelError);
}

TEST_CASE("a material outside what exists is refused by name", "[core][material]") {
  core::Material material = testing::mdf();
  material.poissons_ratio = 0.5;
  CHECK_THROWS_WITH(core::check_material(material), Contains("poissons_ratio: 0.5"));
  material = testing::mdf();
  material.density_kg_per_m3 = 0.0;
  CHECK_THROWS_WITH(core::check_material(material), Contains("density_kg_per_m3: 0"));
  material = testing::mdf();
  material.youngs_modulus_pa = std::nan("");
  CHECK_THROWS_WITH(core::check_material(material), Contains("youngs_modulus_pa"));
}
