// Bodies whose frequencies are known from theory, order 2, each at a stated mesh.
#include <cmath>

#include "core/error.hpp"
#include "core/model/mesh/tetgen_mesher.hpp"
#include "core/model/plate_model.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
using namespace tapstudy;

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
    double flattening;
    double tolerance;  // of the first frequency, at this mesh; the second is half as smooth
  };
  const Sheet sheet = GENERATE(Sheet{{0.3, 0.2, 0.001}, 1.5e-8, 5.0, 0.005},
                               Sheet{{0.6, 0.6, 0.0005}, 2.4e-8, 20.0, 0.12});
  const Eigen::Vector3d& size_m = sheet.size_m;
  CAPTURE(size_m.transpose());
  const auto navier_hz = [&](int m, int n) {
    constexpr double poisson = 0.3;
    return 0.5 * M_PI * (std::pow(m / size_m.x(), 2) + std::pow(n / size_m.y(), 2)) * size_m.z() *
           std::sqrt(youngs_pa / (12.0 * density * (1.0 - poisson * poisson)));
  };
  core::PlateSpec plate = body(size_m, 0.3, sheet.tet_volume_m3, 1.3 * navier_hz(2, 1));
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
