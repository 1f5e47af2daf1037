#include "device/hand/penalty_limit.hpp"

#include <unsupported/Eigen/MatrixFunctions>

#include "support/catch.hpp"

using namespace tapstudy;

namespace {
// The hand against a wall that is sampled, held, and answered so many ticks later, by the matrix
// exponential of (position, velocity, held force).
double spectral_radius(const core::HandBody& hand, double penalty_n_per_m, double dt_s, int delay) {
  Eigen::Matrix3d rate = Eigen::Matrix3d::Zero();
  rate(0, 1) = 1.0;
  rate.row(1) << -hand.muscle_stiffness_n_per_m / hand.mass_kg,
      -hand.muscle_damping_n_s_per_m / hand.mass_kg, 1.0 / hand.mass_kg;
  const Eigen::Matrix3d held = (rate * dt_s).exp();
  Eigen::MatrixXd loop = Eigen::MatrixXd::Zero(2 + delay, 2 + delay);
  loop.topLeftCorner<2, 2>() = held.topLeftCorner<2, 2>();
  for (int i = 0; i < delay; ++i) {
    loop(2 + i, i == 0 ? 0 : 1 + i) = 1.0;
  }
  loop.topRows<2>().col(delay == 0 ? 0 : 1 + delay) -=
      penalty_n_per_m * held.topRightCorner<2, 1>();
  return loop.eigenvalues().cwiseAbs().maxCoeff();
}
}  // namespace

TEST_CASE("at the largest stable penalty the sampled loop neither grows nor dies",
          "[device][stability]") {
  const double mass = GENERATE(0.02, 0.1, 1.0);
  const double stiffness = GENERATE(10.0, 400.0, 5000.0);
  const double damping = GENERATE(0.5, 9.0, 60.0);
  const double rate_hz = GENERATE(500.0, 1000.0, 10000.0);
  const core::HandBody hand{mass, stiffness, damping};
  const int delay = GENERATE(0, 1, 3);
  const double limit = device::largest_stable_penalty_n_per_m(hand, 1.0 / rate_hz, delay);
  CAPTURE(mass, stiffness, damping, rate_hz, delay, limit);
  CHECK(spectral_radius(hand, limit, 1.0 / rate_hz, delay) == Approx(1.0).margin(1e-9));
  CHECK(spectral_radius(hand, 0.99 * limit, 1.0 / rate_hz, delay) < 1.0);
  CHECK(spectral_radius(hand, 1.01 * limit, 1.0 / rate_hz, delay) > 1.0);
}

TEST_CASE("for short ticks the largest stable penalty is 2 b / dt", "[device][stability]") {
  const double dt_s = 1e-6;
  const core::HandBody hand;
  CHECK(device::largest_stable_penalty_n_per_m(hand, dt_s) ==
        Approx(2.0 * hand.muscle_damping_n_s_per_m / dt_s).epsilon(1e-3));
}

TEST_CASE("with a delay, the largest stable penalty tends to b / (dt / 2 + delay)",
          "[device][stability]") {
  const double dt_s = 1e-6;
  const core::HandBody hand;
  CHECK(device::largest_stable_penalty_n_per_m(hand, dt_s, 1) ==
        Approx(hand.muscle_damping_n_s_per_m / (1.5 * dt_s)).epsilon(1e-3));
}
