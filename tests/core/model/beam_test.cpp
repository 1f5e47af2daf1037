#include "core/model/beam.hpp"

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/model/plate_model.hpp"
#include "support/catch.hpp"
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
