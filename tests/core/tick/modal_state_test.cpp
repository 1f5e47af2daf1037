#include "core/tick/modal_state.hpp"

#include <cmath>

#include "core/model/plate_model.hpp"
#include "core/rng.hpp"
#include "core/tick/vibrating_plate.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
#include "support/plates.hpp"
using namespace tapstudy;
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
