#include "analysis/paired/thurstone.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/distributions.hpp"
namespace tapstudy::analysis {
namespace {
void add_pair(double wins, double losses, double distance, const Eigen::VectorXd& direction,
              LikelihoodAt& sum) {
  constexpr double smallest_p = 1e-300;
  const double p = std::max(smallest_p, normal_cdf(distance));
  const double q = std::max(smallest_p, normal_cdf(-distance));
  const double density = normal_density(distance);
  sum.value += wins * std::log(p) + losses * std::log(q);
  sum.score += density * (wins / p - losses / q) * direction;
  // the expected information (Fisher scoring), as in a generalised linear model
  sum.information +=
      (wins + losses) * density * density / (p * q) * direction * direction.transpose();
}

LikelihoodAt likelihood_of_thurstone(const PairedCounts& counts, const Eigen::VectorXd& at) {
  const Eigen::Index items = counts.items();
  LikelihoodAt sum{0.0, Eigen::VectorXd::Zero(items), Eigen::MatrixXd::Zero(items, items)};
  for (Eigen::Index i = 0; i < items; ++i) {
    for (Eigen::Index j = i + 1; j < items; ++j) {
      const double half = 0.5 * counts.ties_of(i, j);
      Eigen::VectorXd direction = Eigen::VectorXd::Unit(items, i);
      direction[j] = -1.0;
      add_pair(counts.wins(i, j) + half, counts.wins(j, i) + half, at[i] - at[j], direction, sum);
    }
  }
  return sum;
}
}  // namespace

PreferenceScale thurstone_case_v(const PairedCounts& counts) {
  check_comparisons(counts, TiesConnect::yes);
  const Eigen::Index items = counts.items();
  return scale_of(
      maximise_scale([&](const Eigen::VectorXd& at) { return likelihood_of_thurstone(counts, at); },
                     items, items),
      items);
}
}  // namespace tapstudy::analysis
