#include "analysis/participants/beta_binomial_score.hpp"

#include <Eigen/LU>

#include "analysis/statistics/numerics.hpp"
namespace tapstudy::analysis {
namespace {
struct Slopes {
  Eigen::Vector2d score{Eigen::Vector2d::Zero()};  // by a = nu mean and b = nu (1 - mean)
  Eigen::Matrix2d curvature{Eigen::Matrix2d::Zero()};
};

// Of sum ln B(k + a, n - k + b) - ln B(a, b).
Slopes slopes_at(const std::vector<Proportion>& people, double a, double b) {
  Slopes sum;
  for (const Proportion& of : people) {
    const auto k = static_cast<double>(of.successes);
    const auto n = static_cast<double>(of.trials);
    const double both = digamma(a + b) - digamma(n + a + b);
    sum.score +=
        Eigen::Vector2d{digamma(k + a) - digamma(a) + both, digamma(n - k + b) - digamma(b) + both};
    const double both_again = trigamma(a + b) - trigamma(n + a + b);
    sum.curvature.array() += both_again;
    sum.curvature(0, 0) += trigamma(k + a) - trigamma(a);
    sum.curvature(1, 1) += trigamma(n - k + b) - trigamma(b);
  }
  return sum;
}
}  // namespace

BetaBinomialParameters refined(const std::vector<Proportion>& people,
                               const BetaBinomialParameters& near) {
  constexpr int steps = 6;
  constexpr double farthest = 1e-2;  // of either, in proportion
  const Eigen::Array2d start{near.nu * near.mean, near.nu * (1.0 - near.mean)};
  Eigen::Array2d at = start;
  for (int i = 0; i < steps; ++i) {
    const Slopes slopes = slopes_at(people, at[0], at[1]);
    at -= slopes.curvature.fullPivLu().solve(slopes.score).array();
    if (!((at / start - 1.0).abs() < farthest).all()) {
      return near;
    }
  }
  return {at[0] / at.sum(), at.sum()};
}
}  // namespace tapstudy::analysis
