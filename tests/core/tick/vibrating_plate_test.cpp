// Where a finger meets elements of order 2, and bodies that are no plates.
#include "core/tick/vibrating_plate.hpp"

#include <cmath>
#include <initializer_list>

#include "core/model/plate_model.hpp"
#include "core/random/rng.hpp"
#include "core/techniques/technique.hpp"
#include "core/tick/modal_state.hpp"
#include "core/tick/state_transition.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
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

using namespace tapstudy::core;

namespace {
StateTransition after(const StateTransition& second, const StateTransition& first) {
  return {second.qq * first.qq + second.qv * first.vq, second.qq * first.qv + second.qv * first.vv,
          second.vq * first.qq + second.vv * first.vq, second.vq * first.qv + second.vv * first.vv};
}
double determinant(const StateTransition& step) {
  return step.qq * step.vv - step.qv * step.vq;
}
// Twice the kinetic plus elastic energy of a unit mass after a step from (q, v).
double energy(const StateTransition& step, double omega, double q, double v) {
  const double q_after = step.qq * q + step.qv * v;
  const double v_after = step.vq * q + step.vv * v;
  return v_after * v_after + omega * omega * q_after * q_after;
}
constexpr std::initializer_list<double> damping_ratios{
    0.0, 0.01, 0.7, 0.999999, 1.0, 1.000001, 1.0000001, 1.004, 1.2, 3.0, 100.0};
constexpr double step_s = 1e-3;
}  // namespace

TEST_CASE("two exact half steps are one exact step", "[core][oscillator]") {
  const double zeta = GENERATE(values<double>(damping_ratios));
  const double omega = GENERATE(1e-6, 1.0, 300.0, 1000.0, 3000.0);
  CAPTURE(zeta, omega);
  const StateTransition half = exact_transition(omega, zeta, 0.5 * step_s);
  const StateTransition twice = after(half, half);
  const StateTransition once = exact_transition(omega, zeta, step_s);
  CHECK(twice.qq == Approx(once.qq).epsilon(1e-10).margin(1e-12));
  CHECK(twice.qv == Approx(once.qv).epsilon(1e-10).margin(1e-15));
  CHECK(twice.vq == Approx(once.vq).epsilon(1e-10).margin(1e-12 * omega));
  CHECK(twice.vv == Approx(once.vv).epsilon(1e-10).margin(1e-12));
}

TEST_CASE("a step shrinks phase space by exp(-2 zeta omega dt) (Liouville)", "[core][oscillator]") {
  const double zeta = GENERATE(values<double>(damping_ratios));
  const double omega = GENERATE(1e-3, 30.0, 300.0, 1500.0);
  CAPTURE(zeta, omega);
  CHECK(determinant(exact_transition(omega, zeta, step_s)) ==
        Approx(std::exp(-2.0 * zeta * omega * step_s)).epsilon(1e-9).margin(1e-12));
}

TEST_CASE("an undamped mode swings at its own frequency", "[core][oscillator]") {
  const double omega = GENERATE(10.0, 300.0, 1885.0);
  double q = 1.0;
  double v = 0.0;
  const StateTransition step = exact_transition(omega, 0.0, step_s);
  for (int tick = 1; tick <= 1000; ++tick) {
    const double q_before = q;
    q = step.qq * q + step.qv * v;
    v = step.vq * q_before + step.vv * v;
  }
  CHECK(q == Approx(std::cos(omega * 1.0)).margin(1e-12 * 1000));
}

TEST_CASE("three hundred ticks of a damped mode are its closed form", "[core][oscillator]") {
  const double hz = GENERATE(30.0, 100.0, 300.0);
  const double zeta = GENERATE(0.0, 0.02, 0.5);
  const double omega = 2.0 * M_PI * hz;
  const double damped = omega * std::sqrt(1.0 - zeta * zeta);
  const StateTransition step = exact_transition(omega, zeta, step_s);
  double q = 0.0;
  double v = omega;
  for (int tick = 1; tick <= 300; ++tick) {
    const double q_before = q;
    q = step.qq * q + step.qv * v;
    v = step.vq * q_before + step.vv * v;
    const double t = tick * step_s;
    REQUIRE(
        q ==
        Approx(omega / damped * std::exp(-zeta * omega * t) * std::sin(damped * t)).margin(1e-12));
  }
}

TEST_CASE("around critical damping nothing jumps", "[core][oscillator]") {
  const double omega = GENERATE(1.0, 300.0, 3000.0);
  const StateTransition critical = exact_transition(omega, 1.0, step_s);
  CHECK(critical.qv == Approx(step_s * std::exp(-omega * step_s)));
  for (const double off : {-1e-8, 1e-8}) {
    const StateTransition near = exact_transition(omega, 1.0 + off, step_s);
    CHECK(near.qq == Approx(critical.qq).epsilon(1e-6));
    CHECK(near.vv == Approx(critical.vv).epsilon(1e-6).margin(1e-9));
  }
}

TEST_CASE("an overdamped mode creeps back without crossing zero", "[core][oscillator]") {
  const double zeta = GENERATE(1.5, 20.0, 100.0);
  const double omega = GENERATE(1.0, 300.0, 1e6);
  const StateTransition step = exact_transition(omega, zeta, step_s);
  CAPTURE(zeta, omega);
  CHECK(std::isfinite(step.vv));
  CHECK(step.qq >= 0.0);
  CHECK(step.qq <= 1.0);
}

TEST_CASE("Newmark rings at 2 atan(omega dt / 2) / dt", "[core][oscillator]") {
  const double hz = GENERATE(30.0, 100.0, 300.0, 499.0);
  const double omega = 2.0 * M_PI * hz;
  const StateTransition step = newmark_transition(omega, 0.0, step_s);
  // the angle of the step's complex eigenvalues
  const double angle = std::acos(0.5 * (step.qq + step.vv));
  CHECK(angle / step_s == Approx(2.0 * std::atan(0.5 * omega * step_s) / step_s).epsilon(1e-12));
  CHECK(determinant(step) == Approx(1.0));
}

TEST_CASE("neither integrator ever gains energy", "[core][oscillator]") {
  const double zeta = GENERATE(0.0, 0.05, 1.0, 100.0);
  const double omega = GENERATE(1e-6, 1.0, 1e3, 1e6, 1e9);
  const auto integrator = GENERATE(Integrator::exact, Integrator::newmark);
  const StateTransition step = state_transition(integrator, omega, zeta, step_s);
  CAPTURE(zeta, omega);
  for (const double angle : {0.0, 0.5, 1.0, 2.0, 3.0}) {
    const double q = std::cos(angle) / omega;
    const double v = std::sin(angle);
    CHECK(energy(step, omega, q, v) <= 1.0 + 1e-12);
  }
}

using core::ModalState;

namespace {
constexpr double dt_s = 1e-3;
const core::Vec3 outward{0.0, 0.0, 1.0};
const core::VibratingPlate& plate() {
  static const core::VibratingPlate shared{
      core::build_plate_model(testing::paper_plate(2, testing::mdf())).modal};
  return shared;
}
ModalState impact(double x, double y, double impulse) {
  ModalState state{plate().model, core::Integrator::exact, dt_s};
  state.touch(plate().locator->locate(x, y), outward);
  state.strike(impulse);
  return state;
}
}  // namespace

TEST_CASE("a place is the weighted mean of the nodes around it", "[core][locator]") {
  core::Rng rng{7};
  for (int i = 0; i < 2000; ++i) {
    const double x = 0.6 * rng.uniform() - 0.3;
    const double y = 0.6 * rng.uniform() - 0.3;
    const core::SurfacePoint point = plate().locator->locate(x, y);
    core::Vec3 found = core::Vec3::Zero();
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      found += point.weights.at(k) * plate().model.touch_nodes_m.row(point.nodes.at(k)).transpose();
      sum += point.weights.at(k);
      CHECK(point.weights.at(k) > -1e-9);
    }
    CHECK(sum == Approx(1.0));
    CHECK((found - core::Vec3{x, y, 0.0}).norm() < 1e-12);
  }
}

TEST_CASE("an impulse moves each mode by its share of it", "[core][modal]") {
  const double impulse = -0.0174;
  const ModalState state = impact(0.24, 0.24, impulse);
  // the velocity of the impact point over the impulse is the sum of squared mode shapes there, and
  // so is twice the energy over the impulse squared
  const double admittance = state.velocity_m_s() / impulse;
  CHECK(admittance > 0.0);
  CHECK(2.0 * state.energy_j() / (impulse * impulse) == Approx(admittance));
}

TEST_CASE("what B feels of a tap on A, A feels of a tap on B (Maxwell, Betti)", "[core][modal]") {
  ModalState at_a = impact(0.1, 0.24, 1.0);
  ModalState at_b = impact(-0.2, 0.05, 1.0);
  at_a.touch(plate().locator->locate(-0.2, 0.05), outward);
  at_b.touch(plate().locator->locate(0.1, 0.24), outward);
  for (int tick = 0; tick < 100; ++tick) {
    at_a.tick();
    at_b.tick();
    CHECK(at_a.displacement_m() == Approx(at_b.displacement_m()).epsilon(1e-9).margin(1e-15));
  }
}

TEST_CASE("a damped plate never gains energy and falls silent, not denormal", "[core][modal]") {
  const auto integrator = GENERATE(core::Integrator::exact, core::Integrator::newmark);
  ModalState state{plate().model, integrator, dt_s};
  state.touch(plate().locator->locate(0.24, 0.24), outward);
  state.strike(1.0);
  double before = state.energy_j();
  for (int tick = 0; tick < 20'000; ++tick) {
    state.tick();
    const double now = state.energy_j();
    CHECK(now <= before * (1.0 + 1e-12));
    before = now;
  }
  CHECK(state.energy_j() == 0.0);
}

TEST_CASE("on its way to silence no displacement and no velocity is ever denormal",
          "[core][modal]") {
  ModalState state = impact(0.1, 0.1, 1.0);
  int loud_ticks = 0;
  while (state.energy_j() > 0.0 && loud_ticks < 100'000) {
    state.tick();
    ++loud_ticks;
    CHECK(std::fpclassify(state.displacement_m()) != FP_SUBNORMAL);
    CHECK(std::fpclassify(state.velocity_m_s()) != FP_SUBNORMAL);
  }
  CHECK(state.displacement_m() == 0.0);
  // the slowest mode needs ln(10^100) / (zeta omega) to fall from 1 to 10^-100
  const Eigen::ArrayXd rate_per_s =
      2.0 * M_PI * plate().model.frequency_hz * plate().model.damping_ratio;
  CHECK(loud_ticks * dt_s == Approx(100.0 * std::log(10.0) / rate_per_s.minCoeff()).epsilon(0.1));
}

TEST_CASE("without damping a plate rings for ever, and with the same energy", "[core][modal]") {
  core::ModalModel model = plate().model;
  model.damping_ratio.setZero();
  ModalState state{model, core::Integrator::exact, dt_s};
  state.touch(plate().locator->locate(0.1, 0.1), outward);
  state.strike(1.0);
  const double at_first = state.energy_j();
  for (int tick = 0; tick < 1'000'000; ++tick) {
    state.tick();
  }
  CHECK(state.energy_j() == Approx(at_first).epsilon(1e-9));
}

TEST_CASE("ten thousand ticks of a vibrating plate allocate nothing", "[core][realtime]") {
  ModalState state = impact(0.1, 0.1, 1.0);
  const testing::AllocationCount allocations;
  for (int tick = 0; tick < 10'000; ++tick) {
    state.touch(plate().locator->locate(0.01 * (tick % 30), 0.1), outward);
    state.tick();
  }
  CHECK(allocations.count() == 0);
}
