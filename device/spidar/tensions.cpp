#include "device/spidar/tensions.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
namespace tapstudy::device {
namespace {
using Vec6 = Eigen::Matrix<double, 6, 1>;
constexpr double tension_weight = 1e-8;
constexpr double share_weight =
    1e-3;  // must exceed tension_weight × 8 × max_n², or force would be lost

Vec6 in_newtons(const Wrench& wrench) noexcept {
  Vec6 all;
  all << wrench.force_n, wrench.torque_nm / grip_radius_m;
  return all;
}
}  // namespace

TensionSolver::TensionSolver(const TensionRange& range) noexcept : range_{range} {
  latest_ << PerString::Constant(range.min_n), 1.0;
}

Tensions TensionSolver::solve(const Strings& strings_now, const Wrench& wanted) noexcept {
  Eigen::Matrix<double, 6, strings + 1> effect;
  effect.leftCols<strings>() = strings_now.pull.transpose();
  effect.bottomRows<3>() /= grip_radius_m;
  effect.col(strings) = -in_newtons(wanted);
  BoxQp<strings + 1> problem;
  problem.Q = effect.transpose() * effect;
  problem.Q.diagonal().array() += tension_weight;
  problem.c.setZero();
  problem.c[strings] = share_weight;
  problem.low << PerString::Constant(range_.min_n), 0.0;
  problem.high << PerString::Constant(range_.max_n), 1.0;
  const BoxQpSolution<strings + 1> solution = solver_.solve(problem, latest_);
  latest_ = solution.x;
  Tensions found;
  found.is_optimal = solution.is_optimal;
  found.tension_n = latest_.head<strings>();
  found.share = latest_[strings];
  const Vec6 achieved = strings_now.pull.transpose() * found.tension_n;
  found.achieved = {achieved.head<3>(), achieved.tail<3>()};
  found.residual_n = (effect * latest_).norm();
  return found;
}

double closure_margin(const Strings& strings_now) noexcept {
  const Eigen::HouseholderQR<Eigen::Matrix<double, strings, 6>> qr{strings_now.pull};
  const Eigen::Matrix<double, strings, strings> q =
      qr.householderQ() * Eigen::Matrix<double, strings, strings>::Identity();
  const Eigen::Matrix<double, strings, 2> idle = q.rightCols<2>();
  double best = -1.0;
  // at the optimum two strings share the smallest entry, or one is at its own maximum
  const auto consider = [&](const Eigen::Vector2d& direction) {
    const double length = direction.norm();
    if (length > 0.0) {
      const PerString shares = idle * direction / length;
      best = std::max({best, shares.minCoeff(), -shares.maxCoeff()});
    }
  };
  for (Eigen::Index i = 0; i < strings; ++i) {
    consider(idle.row(i).transpose());
    for (Eigen::Index j = 0; j < i; ++j) {
      const Eigen::Vector2d apart = (idle.row(i) - idle.row(j)).transpose();
      consider({-apart.y(), apart.x()});
    }
  }
  return best;
}
}  // namespace tapstudy::device
