#include "runner/accuracy/errors.hpp"

#include <catch2/catch.hpp>

using namespace tapstudy;
using namespace tapstudy::runner;

TEST_CASE("a mode that rings where it should has no frequency error", "[runner][trade]") {
  const Eigen::ArrayXd hz = Eigen::ArrayXd::LinSpaced(4, 50.0, 200.0);
  CHECK(frequency_error(hz, hz, 250.0) == 0.0);
  CHECK(frequency_error(hz, 1.1 * hz, 250.0) == Approx(0.1));
  CHECK(frequency_error(hz, numerical_frequency_hz(hz, core::Integrator::exact, 1000.0), 250.0) ==
        0.0);
}

TEST_CASE("Newmark rings at the frequency that its own zero crossings show", "[runner][trade]") {
  constexpr double dt_s = 1e-3;
  for (const double hz : {30.0, 100.0, 300.0}) {
    CAPTURE(hz);
    const core::StateTransition step = core::newmark_transition(2.0 * M_PI * hz, 0.0, dt_s);
    double displacement = 0.0;
    double velocity = 1.0;
    int crossings = 0;
    constexpr int ticks = 200'000;
    for (int tick = 0; tick < ticks; ++tick) {
      const double before = displacement;
      displacement = step.qq * before + step.qv * velocity;
      velocity = step.vq * before + step.vv * velocity;
      crossings += before * displacement < 0.0 ? 1 : 0;
    }
    const Eigen::ArrayXd told = numerical_frequency_hz(Eigen::ArrayXd::Constant(1, hz),
                                                       core::Integrator::newmark, 1.0 / dt_s);
    CHECK(told[0] == Approx(0.5 * crossings / (ticks * dt_s)).epsilon(1e-3));
  }
}

TEST_CASE("a mode lost beyond the band is at least as wrong as the band's edge",
          "[runner][trade]") {
  const Eigen::ArrayXd reference = Eigen::ArrayXd::LinSpaced(2, 100.0, 200.0);
  CHECK(frequency_error(reference, reference.head(1), 300.0) == Approx(0.5));
  // what the reference has beyond the band is not asked for
  CHECK(frequency_error(reference, reference.head(1), 150.0) == 0.0);
}

TEST_CASE("the level of twice the force is 6.02 dB off", "[runner][trade]") {
  const Forces forces = Forces::Random(300, 3);
  CHECK(level_error_db(forces, forces) == 0.0);
  CHECK(level_error_db(forces, 2.0 * forces) == Approx(6.0206).epsilon(1e-4));
  CHECK(level_error_db(forces, -forces) == 0.0);
  CHECK(force_error(forces, -forces) == Approx(2.0));
}

TEST_CASE("one tapping point out of many decides the error", "[runner][trade]") {
  const Forces reference = Forces::Ones(10, 3);
  Forces found = reference;
  found.col(1) *= 1.25;
  CHECK(force_error(reference, found) == Approx(0.25));
}

TEST_CASE("a held output keeps slow vibration and loses that at the rate", "[runner][trade]") {
  const Eigen::ArrayXd hz = Eigen::Array3d{1e-3, 500.0, 1000.0};
  const Eigen::ArrayXd gain = held_gain(hz, 1000.0);
  CHECK(gain[0] == Approx(1.0));
  CHECK(gain[1] == Approx(2.0 / M_PI));
  CHECK(gain[2] == Approx(0.0).margin(1e-15));
}
