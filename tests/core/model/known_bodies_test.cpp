// Bodies whose frequencies are known from theory, order 2, each at a stated mesh.
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
#include "core/model/beam.hpp"
#include "core/model/cubic_elements.hpp"
#include "core/model/discrete_body.hpp"
#include "core/model/element_order.hpp"
#include "core/model/mesh/tetgen_mesher.hpp"
#include "core/model/plate_model.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
using namespace tapstudy;
using namespace tapstudy::core;

namespace {
constexpr double length_m = 0.5;
constexpr double width_m = 0.03;
constexpr double thickness_m = 0.01;
constexpr double youngs_modulus_pa = 3e9;
constexpr double density_kg_per_m3 = 1200.0;
const Material material{youngs_modulus_pa, density_kg_per_m3, 0.0, ConstantDamping{0.02}};

Fixation held(Side side) {
  Fixation fixation;
  fixation.shape = RegionShape::side;
  fixation.side = side;
  return fixation;
}
PlateSpec beam_held(std::vector<Side> sides, double band_limit_hz = 1000.0,
                    Theory theory = Theory::beam) {
  PlateSpec plate;
  plate.shape = Box{{length_m, width_m, thickness_m}};
  for (const Side side : sides) {
    plate.fixations.push_back(held(side));
  }
  plate.material = material;
  plate.band_limit_hz = band_limit_hz;
  plate.theory = theory;
  return plate;
}
double frequency_hz(double lambda) {
  const double bending_n_m2 =
      youngs_modulus_pa * width_m * thickness_m * thickness_m * thickness_m / 12.0;
  const double mass_kg_per_m = density_kg_per_m3 * width_m * thickness_m;
  return lambda * lambda / (2.0 * std::numbers::pi * length_m * length_m) *
         std::sqrt(bending_n_m2 / mass_kg_per_m);
}
// Of a touched node at the free end of the cantilever, per newton, if all modes were there.
double static_compliance(const ModalModel& model, Eigen::Index node) {
  const Eigen::ArrayXd shape = model.shape.row(3 * node + 2).transpose().array();
  const Eigen::ArrayXd omega = 2.0 * std::numbers::pi * model.frequency_hz;
  return (shape / omega).square().sum();
}
}  // namespace

TEST_CASE("a beam's natural frequencies are those of Blevins's table 8-1", "[core][model][beam]") {
  const auto cantilever = build_plate_model(beam_held({Side::left})).modal;
  REQUIRE(cantilever.frequency_hz.size() >= 3);
  CHECK(cantilever.frequency_hz[0] == Approx(frequency_hz(1.87510407)).epsilon(1e-8));
  CHECK(cantilever.frequency_hz[1] == Approx(frequency_hz(4.69409113)).epsilon(1e-8));
  CHECK(cantilever.frequency_hz[2] == Approx(frequency_hz(7.85475744)).epsilon(1e-8));
  const auto both = build_plate_model(beam_held({Side::right, Side::left})).modal;
  REQUIRE(both.frequency_hz.size() >= 3);
  CHECK(both.frequency_hz[0] == Approx(frequency_hz(4.73004074)).epsilon(1e-8));
  CHECK(both.frequency_hz[1] == Approx(frequency_hz(7.85320462)).epsilon(1e-8));
  CHECK(both.frequency_hz[2] == Approx(frequency_hz(10.9956078)).epsilon(1e-8));
}

TEST_CASE("the modes of a cantilever give way at its end by L^3 / 3 E I", "[core][model][beam]") {
  const double stiffness_n_per_m = 3.0 * youngs_modulus_pa * width_m * thickness_m * thickness_m *
                                   thickness_m / 12.0 / (length_m * length_m * length_m);
  const ModalModel held_left = build_plate_model(beam_held({Side::left}, 1e5)).modal;
  const ModalModel held_right = build_plate_model(beam_held({Side::right}, 1e5)).modal;
  const Eigen::Index last = held_left.touch_nodes_m.rows() - 1;
  CHECK(held_left.touch_nodes_m(last, 0) == Approx(0.5 * length_m));
  CHECK(static_compliance(held_left, last) == Approx(1.0 / stiffness_n_per_m).epsilon(1e-4));
  CHECK(static_compliance(held_right, 0) == Approx(1.0 / stiffness_n_per_m).epsilon(1e-4));
  CHECK(static_compliance(held_left, 0) == Approx(0.0).margin(1e-12));
}

TEST_CASE("a beam's shapes are orthogonal, and of unit modal mass", "[core][model][beam]") {
  const auto sides = GENERATE(values<std::vector<Side>>({{Side::left}, {Side::left, Side::right}}));
  const ModalModel model = build_plate_model(beam_held(sides, 2000.0)).modal;
  const Eigen::Index stations = model.touch_nodes_m.rows() / 2;
  Eigen::MatrixXd shapes(stations, model.frequency_hz.size());
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(stations);
  weights[0] = weights[stations - 1] = 0.5;  // trapezia
  for (Eigen::Index i = 0; i < stations; ++i) {
    shapes.row(i) = model.shape.row(6 * i + 2);
  }
  const double mass_kg = density_kg_per_m3 * length_m * width_m * thickness_m;
  const Eigen::MatrixXd modal_mass = shapes.transpose() * weights.asDiagonal() * shapes * mass_kg /
                                     static_cast<double>(stations - 1);
  REQUIRE(modal_mass.rows() >= 4);
  CHECK((modal_mass - Eigen::MatrixXd::Identity(modal_mass.rows(), modal_mass.cols()))
            .cwiseAbs()
            .maxCoeff() < 1e-3);
}

TEST_CASE("a slender plate of finite elements vibrates as its beam", "[core][model][beam]") {
  PlateSpec solid = beam_held({Side::front}, 40.0, Theory::solid);
  solid.shape = Box{{width_m, length_m, thickness_m}};
  solid.mesh.order = 2;
  PlateSpec beam = solid;
  beam.theory = Theory::beam;
  const ModalModel of_solid = build_plate_model(solid).modal;
  const ModalModel of_beam = build_plate_model(beam).modal;
  REQUIRE(of_beam.frequency_hz.size() > 0);
  CHECK(of_beam.frequency_hz[0] == Approx(of_solid.frequency_hz[0]).epsilon(0.01));
}

TEST_CASE("what is no beam is refused", "[core][model][beam]") {
  const auto refuses = [](const PlateSpec& plate) {
    CHECK_FALSE(beam_of(plate));
    CHECK_THROWS_AS(build_plate_model(plate), ModelError);
  };
  refuses(beam_held({}));
  refuses(beam_held({Side::left, Side::front}));
  refuses(beam_held({Side::left, Side::left}));
  refuses(beam_held({Side::top}));
  refuses(beam_held({Side::front}));  // too short across
  PlateSpec hinged = beam_held({Side::left});
  hinged.fixations.front().constrained_axes = {false, false, true};
  refuses(hinged);
  PlateSpec sprung = beam_held({Side::left});
  sprung.fixations.front().springs_n_per_m = Vec3{1e5, 1e5, 1e5};
  refuses(sprung);
  PlateSpec soft = beam_held({Side::left}, 1e8);
  CHECK_THROWS_AS(build_plate_model(soft), ModelError);
}

TEST_CASE("what is wider than a third of its length bends as a plate, and is no beam",
          "[core][model][beam]") {
  PlateSpec plate = beam_held({Side::left});
  CHECK(beam_of(plate));
  plate.shape = Box{{length_m, 0.4 * length_m, thickness_m}};
  CHECK_FALSE(beam_of(plate));
}

namespace {
constexpr double youngs_pa = 70e9;
constexpr double density = 2700.0;

core::PlateSpec body(const Eigen::Vector3d& size_m, double poisson, double tet_volume_m3,
                     double band_hz) {
  core::PlateSpec spec{
      {core::Box{size_m}, {}, {}}, {youngs_pa, density, poisson, core::RayleighDamping{}}, band_hz};
  spec.mesh.order = 2;
  spec.mesh.size.max_tet_volume_m3 = tet_volume_m3;
  return spec;
}
core::Fixation held_side(core::Side side, std::array<bool, 3> axes = {true, true, true}) {
  core::Fixation fixation;
  fixation.shape = core::RegionShape::side;
  fixation.side = side;
  fixation.constrained_axes = axes;
  return fixation;
}
double bending_hz(double root, double length_m, double height_m) {
  return root * root / (2.0 * M_PI * length_m * length_m) *
         std::sqrt(youngs_pa * height_m * height_m / 12.0 / density);
}
}  // namespace

// Euler-Bernoulli: roots 1.8751, 4.6941 of cos x cosh x = -1. Timoshenko's shear and rotary inertia
// lower the first by 0.1 %, the second by 0.9 % at this length to height of 20 (Blevins 1979).
TEST_CASE("a slender cantilever bends as Euler-Bernoulli and Timoshenko say", "[core][model]") {
  core::PlateSpec bar = body({1.0, 0.04, 0.05}, 0.0, 2e-5, 400.0);
  bar.fixations = {held_side(core::Side::left)};
  const auto found = core::build_plate_model(bar).modal.frequency_hz;
  REQUIRE(found.size() == 4);  // two across each way
  CHECK(found[0] == Approx(bending_hz(1.8751041, 1.0, 0.04)).epsilon(0.003));
  CHECK(found[1] == Approx(bending_hz(1.8751041, 1.0, 0.05)).epsilon(0.003));
  CHECK(found[2] == Approx(bending_hz(4.6940911, 1.0, 0.04) * (1.0 - 0.006)).epsilon(0.004));
  CHECK(found[3] == Approx(bending_hz(4.6940911, 1.0, 0.05) * (1.0 - 0.009)).epsilon(0.004));
}

TEST_CASE("a free bar has six zero modes and bends at 4.7300", "[core][model]") {
  const auto built = core::build_plate_model(body({1.0, 0.02, 0.025}, 0.0, 1e-5, 140.0));
  CHECK(built.body.modes.report.rigid_body_modes == 6);
  REQUIRE(built.modal.frequency_hz.size() == 2);
  CHECK(built.modal.frequency_hz[0] == Approx(bending_hz(4.7300407, 1.0, 0.02)).epsilon(0.003));
  CHECK(built.modal.frequency_hz[1] == Approx(bending_hz(4.7300407, 1.0, 0.025)).epsilon(0.003));
}

// Leissa 1969, Vibration of Plates (NASA SP-160), square plates, nu 0.3:
// omega a² sqrt(rho h / D) = 35.985 73.394 73.394 108.22 clamped, 2 pi² (1, 2.5, 2.5, 4) supported.
TEST_CASE("a thin square plate has Leissa's frequencies, clamped and supported",
          "[core][model][slow]") {
  const double width_m = 0.5;
  const double height_m = 0.005;
  const double poisson = 0.3;
  const double rigidity = youngs_pa * std::pow(height_m, 3) / (12.0 * (1.0 - poisson * poisson));
  const double unit_hz =
      std::sqrt(rigidity / (density * height_m)) / (2.0 * M_PI * width_m * width_m);
  core::PlateSpec plate = body({width_m, width_m, height_m}, poisson, 1e-6, 120.0 * unit_hz);
  plate.mesh.size.flattening = 2.5;
  const bool is_clamped = GENERATE(true, false);
  CAPTURE(is_clamped);
  for (const core::Side side :
       {core::Side::left, core::Side::right, core::Side::front, core::Side::back}) {
    plate.fixations.push_back(is_clamped ? held_side(side) : held_side(side, {false, false, true}));
  }
  if (!is_clamped) {
    plate.band_limit_hz = 85.0 * unit_hz;
  }
  const std::vector<double> expected = is_clamped
                                           ? std::vector<double>{35.985, 73.394, 73.394, 108.22}
                                           : std::vector<double>{19.739, 49.348, 49.348, 78.957};
  const auto found = core::build_plate_model(plate).modal.frequency_hz;
  std::vector<double> bending;
  for (const double hz : found) {
    bending.push_back(hz / unit_hz);
  }
  CAPTURE(bending);
  REQUIRE(bending.size() >= expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(bending[i] == Approx(expected[i]).epsilon(0.015));
  }
}

// Lamé's modes of a free cube are exact: omega = pi sqrt(2 G / rho) / a, for any Poisson's ratio
// (Demarest 1971 uses them to check his method); the lowest torsion has 1.39 to 1.4 / pi of it.
TEST_CASE("a free cube has Lamé's exact mode among its modes", "[core][model]") {
  const double side_m = 0.1;
  const double poisson = 0.3;
  const double shear_pa = youngs_pa / (2.0 * (1.0 + poisson));
  const double lame_hz = std::sqrt(2.0 * shear_pa / density) / (2.0 * side_m);
  const auto built =
      core::build_plate_model(body({side_m, side_m, side_m}, poisson, 1.5e-6, 1.02 * lame_hz));
  CHECK(built.body.modes.report.rigid_body_modes == 6);
  const double nearest = (built.modal.frequency_hz / lame_hz - 1.0).abs().minCoeff();
  CHECK(nearest < 0.002);
}

// Navier's solution: f = pi/2 (m²/a² + n²/b²) sqrt(D / rho h), D = E h³ / 12 (1 - nu²) (Leissa
// 1969).
TEST_CASE("sheets of a millimetre and below, simply supported, have Navier's frequencies",
          "[core][model][slow]") {
  struct Sheet {
    Eigen::Vector3d size_m;
    double tet_volume_m3;
    int order;
    double flattening;
    double tolerance;  // of the first frequency, at this mesh; the second is half as smooth
  };
  const Sheet sheet = GENERATE(Sheet{{0.3, 0.2, 0.001}, 1.5e-8, 2, 5.0, 0.005},
                               Sheet{{0.6, 0.6, 0.0005}, 5.3e-8, core::cubic_order, 60.0, 0.005});
  const Eigen::Vector3d& size_m = sheet.size_m;
  CAPTURE(size_m.transpose());
  const auto navier_hz = [&](int m, int n) {
    constexpr double poisson = 0.3;
    return 0.5 * M_PI * (std::pow(m / size_m.x(), 2) + std::pow(n / size_m.y(), 2)) * size_m.z() *
           std::sqrt(youngs_pa / (12.0 * density * (1.0 - poisson * poisson)));
  };
  core::PlateSpec plate = body(size_m, 0.3, sheet.tet_volume_m3, 1.3 * navier_hz(2, 1));
  plate.mesh.order = sheet.order;
  plate.mesh.size.flattening = sheet.flattening;
  for (const core::Side side :
       {core::Side::left, core::Side::right, core::Side::front, core::Side::back}) {
    plate.fixations.push_back(held_side(side, {false, false, true}));
  }
  const auto built = core::build_plate_model(plate);
  REQUIRE(built.modal.frequency_hz.size() >= 2);
  CHECK(built.modal.frequency_hz[0] == Approx(navier_hz(1, 1)).epsilon(sheet.tolerance));
  CHECK(built.modal.frequency_hz[1] == Approx(navier_hz(2, 1)).epsilon(2.0 * sheet.tolerance));
}

// Navier's solution, 1 - 0.9 % by shear and rotary inertia at this thickness (Mindlin 1951).
TEST_CASE("a thin plate that states neither order nor size has its theory's first frequency",
          "[core][model]") {
  const double width_m = 0.5;
  const double height_m = 0.025;
  const double poisson = 0.3;
  const double navier_hz =
      M_PI / (width_m * width_m) *
      std::sqrt(youngs_pa * height_m * height_m / (12.0 * density * (1.0 - poisson * poisson)));
  core::PlateSpec plate{{core::Box{{width_m, width_m, height_m}}, {}, {}},
                        {youngs_pa, density, poisson, core::RayleighDamping{}},
                        1.5 * navier_hz};
  plate.mesh.order = core::chosen_order;
  for (const core::Side side :
       {core::Side::left, core::Side::right, core::Side::front, core::Side::back}) {
    plate.fixations.push_back(held_side(side, {false, false, true}));
  }
  const core::PlateModel usual = core::build_plate_model(plate);
  REQUIRE(usual.modal.frequency_hz.size() > 0);
  CHECK(usual.modal.frequency_hz[0] == Approx(0.991 * navier_hz).epsilon(0.03));
  plate.mesh.order = 1;
  plate.band_limit_hz *= 2.0;
  CHECK(core::build_plate_model(plate).modal.frequency_hz[0] > 1.5 * navier_hz);
}

TEST_CASE("elements are linear where quadratic ones would be too many, unless they are asked for",
          "[core][model][slow]") {
  core::Plate cube{core::Box{{1.0, 1.0, 1.0}}, {}, {held_side(core::Side::bottom)}};
  cube.mesh.order = core::chosen_order;
  const core::Material material{youngs_pa, density, 0.3, core::RayleighDamping{}};
  const auto order = [&](double tets) {
    core::MeshSize size;
    size.max_tet_volume_m3 = 1.0 / tets;
    return core::discretised(cube, material, size, {}, {}).mesh.order();
  };
  CHECK(order(1e3) == 2);
  CHECK(order(4e4) == 1);
  cube.mesh.order = 2;
  CHECK(order(4e4) == 2);
}

TEST_CASE("order 2 comes nearer than order 1 on the same tetrahedra, and from above",
          "[core][model]") {
  core::PlateSpec plate = testing::paper_plate(4, testing::mdf());
  const double linear_hz = core::build_plate_model(plate).modal.frequency_hz[0];
  plate.mesh.order = 2;
  const double quadratic_hz = core::build_plate_model(plate).modal.frequency_hz[0];
  plate.mesh.size.max_tet_volume_m3 = 3e-5;
  const auto fine = core::build_plate_model(plate);
  CHECK(linear_hz > 1.5 * quadratic_hz);
  CHECK(quadratic_hz > fine.modal.frequency_hz[0]);
  // the design's table, by SciPy on TetGen's pq1.414a3e-5
  std::vector<int> rounded;
  for (const double hz : fine.modal.frequency_hz) {
    rounded.push_back(static_cast<int>(std::lround(hz)));
  }
  CHECK(rounded == std::vector<int>{107, 212, 212, 275, 276, 277});
}

TEST_CASE("one body scaled is every material of its Poisson's ratio", "[core][model]") {
  core::PlateSpec plate = testing::paper_plate(3, testing::mdf());
  plate.mesh.order = 2;
  const auto own = core::build_plate_model(plate).modal;
  core::PlateSpec stiffer = plate;
  stiffer.material.youngs_modulus_pa = 7e9;
  stiffer.band_limit_hz = 600.0;
  const auto body = core::solve_body(core::body_of(stiffer));
  const auto scaled = core::model_of(body.modes, plate.material, plate.band_limit_hz);
  REQUIRE(scaled.frequency_hz.size() == own.frequency_hz.size());
  CHECK((scaled.frequency_hz / own.frequency_hz - 1.0).abs().maxCoeff() < 1e-9);
  for (Eigen::Index mode = 0; mode < own.shape.cols(); ++mode) {
    // a double mode's vectors are only fixed as a pair; this plate of three corners has none
    const double overlap = std::abs(own.shape.col(mode).dot(scaled.shape.col(mode))) /
                           own.shape.col(mode).squaredNorm();
    CHECK(overlap == Approx(1.0).epsilon(1e-6));
  }
}

TEST_CASE("an accuracy is reached by refining, and out of reach is refused",
          "[core][model][slow]") {
  core::PlateSpec bar = body({0.3, 0.03, 0.01}, 0.3, 1e-6, 500.0);
  bar.mesh.size.max_tet_volume_m3.reset();
  bar.fixations = {held_side(core::Side::left)};
  bar.mesh.accuracy = 0.01;
  const auto report = core::build_plate_model(bar).body.modes.report;
  REQUIRE(report.refinement.size() >= 2);
  CHECK(report.refinement.back().moved <= 0.01);
  bar.mesh.order = 1;
  bar.mesh.accuracy = 1e-5;
  CHECK_THROWS_WITH(core::build_plate_model(bar), Contains("have not settled"));
}

TEST_CASE("a mode that only finer meshes bring below the band limit is found",
          "[core][model][slow]") {
  core::PlateSpec bar = body({0.3, 0.1, 0.1}, 0.3, 1e-6, 5000.0);
  bar.mesh.order = 1;  // too stiff, the more the coarser
  bar.mesh.size.max_tet_volume_m3.reset();
  bar.fixations = {held_side(core::Side::left)};
  bar.mesh.accuracy = 0.1;
  const auto wide = core::build_plate_model(bar);
  bar.band_limit_hz = 1.02 * wide.modal.frequency_hz[0];
  bar.mesh.accuracy.reset();
  bar.mesh.size.max_tet_volume_m3 = 0.003 / 800.0;  // as in the second round
  CHECK(core::build_plate_model(bar).modal.frequency_hz.size() == 0);
  bar.mesh.accuracy = 0.1;
  bar.mesh.size.max_tet_volume_m3.reset();
  CHECK(core::build_plate_model(bar).modal.frequency_hz.size() > 0);
}

TEST_CASE("a body held by points or a line has no frequencies to refine towards", "[core][model]") {
  core::PlateSpec bar = body({0.3, 0.03, 0.01}, 0.3, 1e-6, 500.0);
  bar.mesh.accuracy = 0.01;
  core::Fixation vertex;
  vertex.at_m = {-0.15, 0.0, 0.0};
  core::Fixation line;
  line.shape = core::RegionShape::box;
  line.low_m = {-0.15, -0.015, 0.0};
  line.high_m = {-0.15, 0.015, 0.0};
  bar.fixations = {held_side(core::Side::left), GENERATE_COPY(vertex, line)};
  CHECK_THROWS_WITH(core::build_plate_model(bar), Contains("fixation 2 is a point or a line"));
}

TEST_CASE("the area held by a side is that side's, by a disc nearly a circle's", "[core][model]") {
  const core::Shape shape = core::Box{{0.3, 0.2, 0.01}};
  core::Fixation disc;
  disc.shape = core::RegionShape::disc;
  disc.at_m = {0.1, 0.05, 0.0};
  disc.radius_m = 0.02;
  disc.face = core::Face::top;
  const std::vector<core::Fixation> fixations{held_side(core::Side::left), disc};
  core::MeshSize size;
  size.max_tet_volume_m3 = 1e-8;
  const core::TetMesh mesh = core::mesh_shape(shape, size, core::points_to_mesh(fixations, shape));
  const std::vector<double> areas_m2 = core::held_areas_m2(mesh, shape, fixations);
  CHECK(areas_m2.at(0) == Approx(0.2 * 0.01));
  CHECK(areas_m2.at(1) == Approx(M_PI * 0.02 * 0.02).epsilon(0.15));
}

TEST_CASE("a region of which a mesh holds but few nodes is told, of a finer mesh no more",
          "[core][model]") {
  const core::Shape shape = core::Solid{testing::box_surface({0.1, 0.06, 0.05}, 4)};
  core::Fixation ball;
  ball.shape = core::RegionShape::ball;
  ball.at_m = {0.0, 0.0, core::bounds(shape).low_m.z()};
  ball.radius_m = 0.01;
  core::MeshSize size;
  const auto told = [&] {
    return core::held_in_part(core::to_quadratic(core::mesh_shape(shape, size)), shape, {ball});
  };
  REQUIRE(told().size() == 1);
  CHECK_THAT(told().front(), Contains("fixation 1, the ball of radius 0.01 m"));
  size.max_tet_volume_m3 = 3e-9;
  CHECK(told().empty());
}

// The free cube by the Ritz method that Demarest 1971 (J. Acoust. Soc. Am. 49, 768) introduced for
// it: displacements as products of Legendre polynomials, whose integrals have closed forms.
namespace {
constexpr int highest_degree = 11;

// Over [-1, 1]: of P_i P_j, P_i P_j', P_i' P_j, P_i' P_j'.
double integral(int i, bool is_derived_i, int j, bool is_derived_j) {
  const bool is_even = (i + j) % 2 == 0;
  if (is_derived_i && is_derived_j) {
    const int least = std::min(i, j);
    return is_even ? least * (least + 1.0) : 0.0;
  }
  if (is_derived_j) {
    return i < j && !is_even ? 2.0 : 0.0;
  }
  if (is_derived_i) {
    return integral(j, false, i, true);
  }
  return i == j ? 2.0 / (2.0 * i + 1.0) : 0.0;
}

using Degrees = std::array<int, 3>;

// Of one function derived along axis a times another derived along b; -1: not derived.
double integral(const Degrees& f, int a, const Degrees& g, int b) {
  double product = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    product *= integral(f.at(i), axis == a, g.at(i), axis == b);
  }
  return product;
}

std::vector<Degrees> basis() {
  std::vector<Degrees> all;
  for (int i = 0; i <= highest_degree; ++i) {
    for (int j = 0; i + j <= highest_degree; ++j) {
      for (int k = 0; i + j + k <= highest_degree; ++k) {
        all.push_back({i, j, k});
      }
    }
  }
  return all;
}

// Natural angular frequencies [rad/s], the six zero ones included, of a cube of 2 m side with
// density 1, by Hooke's law between every two functions and axes.
Eigen::ArrayXd free_cube(double lambda, double shear) {
  const std::vector<Degrees> functions = basis();
  const auto count = static_cast<Eigen::Index>(functions.size());
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(3 * count, 3 * count);
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(3 * count, 3 * count);
  for (Eigen::Index m = 0; m < count; ++m) {
    for (Eigen::Index n = 0; n < count; ++n) {
      const Degrees& f = functions[static_cast<std::size_t>(m)];
      const Degrees& g = functions[static_cast<std::size_t>(n)];
      const double laplace = integral(f, 0, g, 0) + integral(f, 1, g, 1) + integral(f, 2, g, 2);
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
          stiffness(a * count + m, b * count + n) = lambda * integral(f, a, g, b) +
                                                    shear * integral(f, b, g, a) +
                                                    (a == b ? shear * laplace : 0.0);
        }
        mass(a * count + m, a * count + n) = integral(f, -1, g, -1);
      }
    }
  }
  return core::symmetric_eigenpairs(stiffness, mass).values.cwiseMax(0.0).cwiseSqrt();
}
}  // namespace

TEST_CASE("a free cube rings as Demarest's Ritz method says, mode by mode", "[core][model][slow]") {
  const double poisson = GENERATE(0.0, 0.3);
  const core::Material material{1.0, 1.0, poisson, {}};
  core::PlateSpec cube{{core::Box{{2.0, 2.0, 2.0}}, {}, {}}, material, 0.32};
  cube.mesh.order = 2;
  cube.mesh.size.max_tet_volume_m3 = 8.0 / 2000.0;
  const core::PlateModel ours = core::build_plate_model(cube);
  CHECK(ours.body.modes.report.rigid_body_modes == 6);
  const Eigen::Index modes = ours.modal.frequency_hz.size();
  REQUIRE(modes >= 10);
  const double shear = 1.0 / (2.0 * (1.0 + poisson));
  const Eigen::ArrayXd ritz =
      free_cube(poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), shear) / (2.0 * M_PI);
  for (Eigen::Index i = 0; i < modes; ++i) {
    CAPTURE(poisson, i, ours.modal.frequency_hz[i]);
    // both come from above (Rayleigh); the polynomials have settled to 1e-4
    CHECK(ours.modal.frequency_hz[i] > (1.0 - 1e-4) * ritz[i + 6]);
    CHECK(ours.modal.frequency_hz[i] < 1.002 * ritz[i + 6]);
  }
}
