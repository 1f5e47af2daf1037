#include "device/hand/penalty_limit.hpp"

#include <Eigen/Core>
#include <cmath>
namespace tapstudy::device {
namespace {
constexpr int squarings = 60;
constexpr int bisections = 60;

// The loop over one tick: position, velocity, and the positions whose force is still to come, the
// latest first.
Eigen::MatrixXd closed_loop(const core::HandBody& hand, double dt_s, int delay_ticks,
                            double penalty_n_per_m) {
  const auto [qq, qv, vq, vv] = muscle_transition(hand, dt_s);
  const Eigen::Index states = 2 + delay_ticks;
  Eigen::MatrixXd loop = Eigen::MatrixXd::Zero(states, states);
  loop.topLeftCorner(2, 2) << qq, qv, vq, vv;
  if (delay_ticks > 0) {
    loop(2, 0) = 1.0;
    loop.bottomRows(delay_ticks - 1).middleCols(2, delay_ticks - 1).setIdentity();
  }
  // a held force shifts the muscle's equilibrium by f / k
  const Eigen::Vector2d response = Eigen::Vector2d{1.0 - qq, -vq} / hand.muscle_stiffness_n_per_m;
  loop.col(delay_ticks == 0 ? 0 : states - 1).head(2) -= penalty_n_per_m * response;
  return loop;
}

// By the growth of its powers, squared again and again.
bool dies_out(Eigen::MatrixXd power) {
  double log_size = 0.0;
  for (int i = 0; i < squarings; ++i) {
    const double size = power.norm();
    power /= size;
    log_size = 2.0 * (log_size + std::log(size));
    power = power * power;
  }
  return log_size < 0.0;
}
}  // namespace

double largest_stable_penalty_n_per_m(const core::HandBody& hand, double dt_s, int delay_ticks) {
  const auto rests = [&](double penalty_n_per_m) {
    return dies_out(closed_loop(hand, dt_s, delay_ticks, penalty_n_per_m));
  };
  double stable = 0.0;
  double unstable = 1e-3 * hand.muscle_stiffness_n_per_m;
  while (rests(unstable)) {
    stable = unstable;
    unstable *= 1.5;
  }
  for (int i = 0; i < bisections; ++i) {
    const double middle = 0.5 * (stable + unstable);
    (rests(middle) ? stable : unstable) = middle;
  }
  return stable;
}
}  // namespace tapstudy::device
