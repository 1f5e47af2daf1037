#include "core/tick/state_transition.hpp"

#include <cmath>
#include <initializer_list>

#include "support/catch.hpp"
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
