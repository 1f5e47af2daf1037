// Where a finger meets elements of order 2, and bodies that are no plates.
#include "core/tick/surface_point.hpp"

#include <cmath>

#include "core/model/plate_model.hpp"
#include "core/rng.hpp"
#include "core/techniques/make_renderer.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
#include "support/surfaces.hpp"
using namespace tapstudy;
using core::Vec3;

namespace {
core::ModalModel quadratic_plate() {
  core::PlateSpec plate = testing::paper_plate(2, testing::mdf());
  plate.mesh.order = 2;
  return core::build_plate_model(plate).modal;
}
std::array<double, 3> somewhere(core::Rng& rng) {
  const double a = rng.uniform();
  const double b = rng.uniform() * (1.0 - a);
  return {a, b, 1.0 - a - b};
}
// A sphere of MDF, held at its lowest cap.
const core::VibratingPlate& sphere() {
  static const core::VibratingPlate body = [] {
    core::PlateSpec spec{
        {core::Solid{testing::sphere_surface(0.1, 8)}, {}, {}}, testing::mdf(), 6000.0};
    core::Fixation cap;
    cap.shape = core::RegionShape::ball;
    cap.at_m = {0.0, 0.0, -0.1};
    cap.radius_m = 0.05;
    spec.fixations = {cap};
    return core::VibratingPlate::touched_all_over(core::build_plate_model(spec).modal);
  }();
  return body;
}
// Goes straight in along -outward, stays 3 mm deep, and tells the force of each tick.
std::vector<core::RenderedTick> tapped(core::TapRenderer& renderer, const Vec3& at_m,
                                       const Vec3& outward) {
  std::vector<core::RenderedTick> ticks;
  renderer.tick({at_m + 0.01 * outward, -0.3 * outward});
  for (int tick = 0; tick < 200; ++tick) {
    ticks.push_back(renderer.tick({at_m - 0.003 * outward, -0.3 * outward}));
  }
  return ticks;
}
}  // namespace

TEST_CASE("shape functions of order 2 give every quadratic field exactly", "[core][locator]") {
  core::ModalModel::Triangles triangle{1, 6};
  triangle << 0, 1, 2, 3, 4, 5;
  const Eigen::Matrix<double, 6, 2> nodes =
      (Eigen::Matrix<double, 6, 2>() << 0, 0, 1, 0, 0, 1, 0.5, 0, 0.5, 0.5, 0, 0.5).finished();
  const auto field = [](double x, double y) {
    return 2.0 - x + 3.0 * y + x * x - 4.0 * x * y + 0.5 * y * y;
  };
  core::Rng rng{3};
  for (int i = 0; i < 100; ++i) {
    const std::array<double, 3> at = somewhere(rng);
    const core::SurfacePoint point = core::surface_point(triangle, 0, at);
    double sum = 0.0;
    double ones = 0.0;
    for (std::size_t k = 0; k < point.count; ++k) {
      sum += point.weights.at(k) * field(nodes(point.nodes.at(k), 0), nodes(point.nodes.at(k), 1));
      ones += point.weights.at(k);
    }
    CHECK(ones == Approx(1.0));
    CHECK(sum == Approx(field(at[1], at[2])).margin(1e-12));
  }
}

TEST_CASE("on a plate of order 2 a finger on a middle node feels that node alone",
          "[core][locator]") {
  const core::ModalModel model = quadratic_plate();
  REQUIRE(model.touch_surface.cols() == 6);
  const core::VibratingPlate plate{model};
  for (Eigen::Index triangle = 0; triangle < model.touch_surface.rows(); triangle += 7) {
    const int middle = model.touch_surface(triangle, 3);
    const core::SurfacePoint point =
        plate.locator->locate(model.touch_nodes_m(middle, 0), model.touch_nodes_m(middle, 1));
    for (std::size_t k = 0; k < point.count; ++k) {
      CHECK(point.weights.at(k) == Approx(point.nodes.at(k) == middle ? 1.0 : 0.0).margin(1e-9));
    }
  }
}

TEST_CASE("a body touched all over vibrates on its upper face as the plate that it is",
          "[core][technique]") {
  const core::ModalModel model = quadratic_plate();
  const core::VibratingPlate plate{model};
  const core::VibratingPlate body = core::VibratingPlate::touched_all_over(model);
  const core::Technique& fem = *core::find_technique("fem");
  for (const Vec3& at : {Vec3{0.24, 0.24, 0.0}, Vec3{-0.1, 0.05, 0.0}, Vec3{0.0, -0.2, 0.0}}) {
    core::TapRenderer as_plate = core::make_renderer(fem, {}, core::PlateFace{0.3, 0.3}, &plate);
    core::TapRenderer as_body = core::make_renderer(fem, {}, body.triangles, &body);
    const auto one = tapped(as_plate, at, Vec3::UnitZ());
    const auto other = tapped(as_body, at, Vec3::UnitZ());
    double largest = 0.0;
    for (std::size_t tick = 0; tick < one.size(); ++tick) {
      largest = std::max(largest, std::abs(one[tick].parts.vibration_n));
      CHECK(other[tick].parts.vibration_n ==
            Approx(one[tick].parts.vibration_n).epsilon(1e-5).margin(1e-9));
    }
    CHECK(largest > 1e-6);
  }
}

TEST_CASE("a sphere is felt along its normal wherever it is tapped, and as the modes say",
          "[core][technique]") {
  const core::RenderSettings settings;
  for (const Vec3& towards : {Vec3{0, 0, 1}, Vec3{1, 0, 0.5}, Vec3{-0.3, 0.8, 0.2}}) {
    const Vec3 outward = towards.normalized();
    core::TapRenderer renderer =
        core::make_renderer(*core::find_technique("fem"), settings, sphere().triangles, &sphere());
    const auto ticks = tapped(renderer, 0.1 * outward, outward);
    const core::Contact& contact = ticks.front().contact;
    REQUIRE(contact.impact);
    CHECK(contact.normal.dot(outward) > 0.9);
    // the impact's own tick: f = b v with v = sum of phi^2 p, phi the modes along the normal
    const core::SurfacePoint point = sphere().place_of(contact);
    Eigen::ArrayXd along = Eigen::ArrayXd::Zero(sphere().model.frequency_hz.size());
    for (std::size_t k = 0; k < point.count; ++k) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        along += point.weights.at(k) * contact.normal[axis] *
                 sphere().model.shape.row(3 * point.nodes.at(k) + axis).transpose().array();
      }
    }
    const double impulse = -settings.finger.mass_kg * contact.impact_speed_m_s;
    CHECK(ticks.front().parts.vibration_n ==
          Approx(settings.finger.damping_n_s_per_m * along.square().sum() * impulse));
    for (const core::RenderedTick& tick : ticks) {
      CHECK((tick.force_n - tick.parts.total_n() * tick.contact.normal).norm() < 1e-12);
    }
  }
}
