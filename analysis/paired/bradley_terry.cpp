#include "analysis/paired/bradley_terry.hpp"

#include <array>
#include <cmath>
namespace tapstudy::analysis {
namespace {
// The model is log-linear: an answer's probability is proportional to exp(features . parameters).
struct Answer {
  Eigen::VectorXd features;
  double count{};
};

void add_pair(const std::array<Answer, 3>& answers, std::size_t kinds, const Eigen::VectorXd& at,
              LikelihoodAt& sum) {
  std::array<double, 3> weights{};
  double total_weight = 0.0;
  double total = 0.0;
  for (std::size_t a = 0; a < kinds; ++a) {
    weights[a] = std::exp(answers[a].features.dot(at));
    total_weight += weights[a];
    total += answers[a].count;
  }
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(at.size());
  for (std::size_t a = 0; a < kinds; ++a) {
    const double p = weights[a] / total_weight;
    mean += p * answers[a].features;
    sum.value += answers[a].count > 0.0 ? answers[a].count * std::log(p) : 0.0;
    sum.score += (answers[a].count - total * p) * answers[a].features;
    sum.information += total * p * answers[a].features * answers[a].features.transpose();
  }
  sum.information -= total * mean * mean.transpose();
}

// Parameters: the items' values, then ln nu if there are ties.
LikelihoodAt likelihood_of_bradley_terry(const PairedCounts& counts, const Eigen::VectorXd& at) {
  const Eigen::Index items = counts.items();
  const bool has_ties = at.size() > items;
  const auto unit = [&](Eigen::Index i) { return Eigen::VectorXd::Unit(at.size(), i); };
  LikelihoodAt sum{0.0, Eigen::VectorXd::Zero(at.size()),
                   Eigen::MatrixXd::Zero(at.size(), at.size())};
  for (Eigen::Index i = 0; i < items; ++i) {
    for (Eigen::Index j = i + 1; j < items; ++j) {
      std::array<Answer, 3> answers{
          Answer{unit(i), static_cast<double>(counts.wins(i, j))},
          Answer{unit(j), static_cast<double>(counts.wins(j, i))},
          Answer{0.5 * (unit(i) + unit(j)), static_cast<double>(counts.ties_of(i, j))}};
      if (has_ties) {
        answers[2].features[items] = 1.0;
      }
      add_pair(answers, has_ties ? 3 : 2, at, sum);
    }
  }
  return sum;
}
}  // namespace

BradleyTerry bradley_terry(const PairedCounts& counts) {
  check_comparisons(counts, TiesConnect::no);
  const Eigen::Index items = counts.items();
  const bool has_ties = counts.ties.size() != 0 && counts.ties.sum() > 0;
  const ScaleMaximum maximum = maximise_scale(
      [&](const Eigen::VectorXd& at) { return likelihood_of_bradley_terry(counts, at); }, items,
      has_ties ? items + 1 : items);
  return {scale_of(maximum, items), has_ties ? std::exp(maximum.at[items]) : 0.0};
}
}  // namespace tapstudy::analysis
