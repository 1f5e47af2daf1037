// Bodies on springs: what a rigid body on an elastic foundation does, and where springs become
// constraints.
#include <array>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/model/plate_model.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
using namespace tapstudy;

namespace {
const core::Vec3 size_m{0.3, 0.2, 0.05};

core::PlateSpec block(int order, double tet_volume_m3) {
  core::PlateSpec spec{
      {core::Box{size_m}, {}, {}}, {200e9, 7800.0, 0.3, core::RayleighDamping{}}, 100.0};
  spec.mesh.order = order;
  spec.mesh.size.max_tet_volume_m3 = tet_volume_m3;
  return spec;
}
core::Fixation bottom() {
  core::Fixation fixation;
  fixation.shape = core::RegionShape::side;
  fixation.side = core::Side::bottom;
  return fixation;
}
core::Fixation bottom_on(const core::Vec3& springs_n_per_m) {
  core::Fixation fixation = bottom();
  fixation.springs_n_per_m = springs_n_per_m;
  return fixation;
}
double hz(double stiffness, double inertia) {
  return std::sqrt(stiffness / inertia) / (2.0 * std::numbers::pi);
}
}  // namespace

// k / A per area under a base of a × b: k up and down, k a²/12 in rocking about the base's middle
// line; without sideways stiffness the body rocks about its centre of mass, m (a² + h²) / 12.
TEST_CASE("a stiff block on a soft foundation bounces and rocks as a rigid body, on any mesh",
          "[core][model]") {
  const double k = 2e5;
  const auto [order, volume_m3] =
      GENERATE(table<int, double>({{1, 1e-4}, {1, 2e-6}, {2, 1e-4}, {2, 1e-5}}));
  CAPTURE(order, volume_m3);
  core::PlateSpec spec = block(order, volume_m3);
  spec.fixations = {bottom_on({0.0, 0.0, k})};
  const core::PlateModel built = core::build_plate_model(spec);
  const double mass_kg = 7800.0 * size_m.prod();
  const auto rocking_hz = [&](double edge_m) {
    return hz(k * edge_m * edge_m / 12.0,
              mass_kg * (edge_m * edge_m + size_m.z() * size_m.z()) / 12.0);
  };
  std::array<double, 3> expected{hz(k, mass_kg), rocking_hz(size_m.x()), rocking_hz(size_m.y())};
  std::ranges::sort(expected);
  CHECK(built.body.modes.report.rigid_body_modes == 3);  // along x, along y, about z
  REQUIRE(built.modal.frequency_hz.size() == 3);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(built.modal.frequency_hz[static_cast<Eigen::Index>(i)] ==
          Approx(expected.at(i)).epsilon(1e-4));
  }
}

// k / A per area under a disc: k r²/4 in rocking about any of its diameters.
TEST_CASE("a block on a soft disc rocks as on the disc itself, on any mesh", "[core][model]") {
  const double k = 2e5;
  const double radius_m = 0.03;
  const auto [order, volume_m3] =
      GENERATE(table<int, double>({{1, 1e-4}, {1, 2e-6}, {2, 1e-4}, {2, 1e-5}}));
  CAPTURE(order, volume_m3);
  core::PlateSpec spec = block(order, volume_m3);
  core::Fixation pad;
  pad.shape = core::RegionShape::disc;
  pad.face = core::Face::bottom;
  pad.radius_m = radius_m;
  pad.springs_n_per_m = core::Vec3{0.0, 0.0, k};
  spec.fixations = {pad};
  const core::PlateModel built = core::build_plate_model(spec);
  const double mass_kg = 7800.0 * size_m.prod();
  const auto rocking_hz = [&](double edge_m) {
    return hz(k * radius_m * radius_m / 4.0,
              mass_kg * (edge_m * edge_m + size_m.z() * size_m.z()) / 12.0);
  };
  REQUIRE(built.modal.frequency_hz.size() == 3);
  CHECK(built.modal.frequency_hz[0] == Approx(rocking_hz(size_m.x())).epsilon(2e-3));
  CHECK(built.modal.frequency_hz[1] == Approx(rocking_hz(size_m.y())).epsilon(2e-3));
  CHECK(built.modal.frequency_hz[2] == Approx(hz(k, mass_kg)).epsilon(1e-3));
}

TEST_CASE("springs lower every frequency below that of the constraint that they become in the end",
          "[core][model]") {
  core::PlateSpec spec = block(2, 2e-5);
  spec.band_limit_hz = 25000.0;
  spec.fixations = {bottom()};
  const Eigen::ArrayXd held_hz = core::build_plate_model(spec).modal.frequency_hz;
  REQUIRE(held_hz.size() >= 3);
  double before_hz = 0.0;
  for (const double k : {1e8, 1e10, 1e12, 1e16}) {
    spec.fixations = {bottom_on({k, k, k})};
    const Eigen::ArrayXd sprung_hz = core::build_plate_model(spec).modal.frequency_hz;
    CHECK((sprung_hz.head(held_hz.size()) < held_hz).all());
    CHECK(sprung_hz[0] > before_hz);
    before_hz = sprung_hz[0];
  }
  CHECK(before_hz == Approx(held_hz[0]).epsilon(1e-3));
}

TEST_CASE("a support smaller than the elements shares its spring out over its nodes",
          "[core][model]") {
  core::PlateSpec plate = testing::paper_plate(4, testing::mdf());
  const double mass_kg = 610.0 * 0.6 * 0.6 * 0.05;
  for (core::Fixation& corner : plate.fixations) {
    corner.springs_n_per_m = core::Vec3{0.0, 0.0, 100.0};  // of both its nodes
  }
  plate.band_limit_hz = 1.0;
  const Eigen::ArrayXd found_hz = core::build_plate_model(plate).modal.frequency_hz;
  REQUIRE(found_hz.size() == 1);  // rocking is faster: the corners are far out
  CHECK(found_hz[0] == Approx(hz(400.0, mass_kg)).epsilon(1e-4));
}

TEST_CASE("a spring that no node is held by is refused", "[core][model]") {
  core::PlateSpec spec = block(1, 1e-4);
  core::Fixation fixation;
  fixation.shape = core::RegionShape::ball;
  fixation.at_m = {1.0, 0.0, 0.0};
  fixation.radius_m = 0.1;
  fixation.springs_n_per_m = core::Vec3{1.0, 1.0, 1.0};
  spec.fixations = {fixation};
  CHECK_THROWS_AS(core::build_plate_model(spec), core::ModelError);
}
