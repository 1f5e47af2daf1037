// Meshes that are chosen for an accuracy, against theory.
#include "core/model/refinement/refinement.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.hpp"
#include "core/model/cubic_elements.hpp"
#include "core/model/plate_model.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using namespace tapstudy::core;

namespace {
constexpr double e_pa = 7e10;
constexpr double rho = 2700.0;

PlateSpec on_automatic_mesh(const Vec3& size_m, double poisson, double band_hz) {
  PlateSpec spec{{Box{size_m}, {}, {}}, {e_pa, rho, poisson, RayleighDamping{}}, band_hz};
  spec.mesh.is_automatic = true;
  return spec;
}
Fixation side_held(Side side, std::array<bool, 3> axes = {true, true, true}) {
  Fixation fixation;
  fixation.shape = RegionShape::side;
  fixation.side = side;
  fixation.constrained_axes = axes;
  return fixation;
}
}  // namespace

// Navier's solution (Leissa 1969): f = pi/2 (m²/a² + n²/b²) sqrt(E h² / 12 rho (1 - nu²)).
TEST_CASE("an automatic mesh has the accuracy that is asked of it, of a plate on simple supports",
          "[core][model][refinement]") {
  constexpr double poisson = 0.3;
  const Vec3 size_m{0.3, 0.2, 0.006};
  const auto navier_hz = [&](int m, int n) {
    return 0.5 * std::numbers::pi * (std::pow(m / size_m.x(), 2) + std::pow(n / size_m.y(), 2)) *
           size_m.z() * std::sqrt(e_pa / (12.0 * rho * (1.0 - poisson * poisson)));
  };
  PlateSpec sheet = on_automatic_mesh(size_m, poisson, 1.2 * navier_hz(2, 1));
  for (const Side side : {Side::left, Side::right, Side::front, Side::back}) {
    const bool is_across_x = side == Side::left || side == Side::right;
    sheet.fixations.push_back(side_held(side, {!is_across_x, is_across_x, true}));
  }
  sheet.mesh.accuracy = 0.02;
  const PlateModel built = build_plate_model(sheet);
  REQUIRE(built.modal.frequency_hz.size() == 2);
  CHECK(built.modal.frequency_hz[0] == Approx(navier_hz(1, 1)).epsilon(0.02));
  CHECK(built.modal.frequency_hz[1] == Approx(navier_hz(2, 1)).epsilon(0.02));
  const ModelReport& report = built.body.modes.report;
  CHECK(report.order() == 2);
  CHECK(report.dofs <= 1.3 * max_automatic_dofs);
  CHECK(2.0 * frequency_errors(built.body.modes, sheet.material, sheet.band_limit_hz).largest() <=
        0.02);
  CHECK(report.refinement.back().tets == report.tets);
}

namespace {
// A square one, on an automatic mesh, in the band of its first three modes.
struct ClampedPlate {
  PlateSpec plate;
  double unit_hz;  // sqrt(D / rho h) / 2 pi a²
};
ClampedPlate clamped_plate(double width_m, double height_m) {
  const double unit_hz = std::sqrt(e_pa * height_m * height_m / (12.0 * (1.0 - 0.3 * 0.3) * rho)) /
                         (2.0 * std::numbers::pi * width_m * width_m);
  PlateSpec plate = on_automatic_mesh({width_m, width_m, height_m}, 0.3, 90.0 * unit_hz);
  for (const Side side : {Side::left, Side::right, Side::front, Side::back}) {
    plate.fixations.push_back(side_held(side));
  }
  return {plate, unit_hz};
}
}  // namespace

// Leissa 1969, nu 0.3: omega a² sqrt(rho h / D) = 35.985, 73.394, 73.394. Shear and rotary inertia
// lower these by less than 2 % at this thickness (Mindlin 1951).
TEST_CASE("an automatic mesh is as coarse as the accuracy allows, of a clamped plate",
          "[core][model][refinement]") {
  constexpr double accuracy = 0.1;
  auto [plate, unit_hz] = clamped_plate(0.5, 0.015);
  plate.mesh.accuracy = accuracy;
  const PlateModel built = build_plate_model(plate);
  REQUIRE(built.modal.frequency_hz.size() == 3);
  CHECK(built.modal.frequency_hz[0] == Approx(35.985 * unit_hz).epsilon(accuracy));
  CHECK(built.modal.frequency_hz[1] == Approx(73.394 * unit_hz).epsilon(accuracy));
  const std::vector<RefinementRound>& rounds = built.body.modes.report.refinement;
  REQUIRE(rounds.size() >= 2);
  CHECK(rounds[rounds.size() - 2].tets <= rounds.back().tets);
  CHECK(built.body.modes.report.dofs < max_automatic_dofs / 2);
}

// Navier's solution again. A mode's shape is sin sin times 2 over the square root of the mass.
TEST_CASE("flat elements bend as a sheet does where they are cubic, and not where quadratic",
          "[core][model]") {
  const Vec3 size_m{0.1, 0.1, 0.0005};
  const double first_hz = std::numbers::pi / std::pow(size_m.x(), 2) * size_m.z() *
                          std::sqrt(e_pa / (12.0 * rho * (1.0 - 0.3 * 0.3)));
  PlateSpec sheet{{Box{size_m}, {}, {}}, {e_pa, rho, 0.3, RayleighDamping{}}, 2.0 * first_hz};
  sheet.mesh.size = {1.414, 5e-9, 40.0};
  for (const Side side : {Side::left, Side::right, Side::front, Side::back}) {
    sheet.fixations.push_back(side_held(side, {false, false, true}));
  }
  sheet.mesh.order = cubic_order;
  const PlateModel cubic = build_plate_model(sheet);
  REQUIRE(cubic.modal.frequency_hz.size() == 1);
  CHECK(cubic.modal.frequency_hz[0] == Approx(first_hz).epsilon(0.01));
  const double most = cubic.modal.shape.col(0).cwiseAbs().maxCoeff();
  CHECK(most == Approx(2.0 / std::sqrt(rho * size_m.prod())).epsilon(0.02));
  CHECK_THAT(cubic.body.modes.estimate.not_estimated, Contains("no elements above order 3"));
  sheet.mesh.order = 2;
  sheet.band_limit_hz = 10.0 * first_hz;
  CHECK(build_plate_model(sheet).modal.frequency_hz[0] > 1.2 * first_hz);
}

TEST_CASE("a point, which holds no solid, is refused on an automatic mesh",
          "[core][model][refinement]") {
  PlateSpec plate = on_automatic_mesh({0.3, 0.3, 0.03}, 0.3, 1000.0);
  plate.fixations.emplace_back();
  CHECK_THROWS_WITH(build_plate_model(plate), Contains("mesh: auto: fixation 1 is a point"));
}
