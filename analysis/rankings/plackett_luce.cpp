#include "analysis/rankings/plackett_luce.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/paired/paired_counts.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
// How often each item stood before each other.
PairedCounts pairs_of(const std::vector<Ranking>& rankings, std::size_t items) {
  const auto count = static_cast<Eigen::Index>(items);
  PairedCounts counts{Eigen::MatrixXi::Zero(count, count), {}};
  for (const Ranking& ranking : rankings) {
    for (std::size_t place = 0; place < ranking.size(); ++place) {
      for (std::size_t later = place + 1; later < ranking.size(); ++later) {
        ++counts.wins(static_cast<Eigen::Index>(ranking[place]),
                      static_cast<Eigen::Index>(ranking[later]));
      }
    }
  }
  return counts;
}

void add(const Ranking& ranking, const Eigen::VectorXd& at, LikelihoodAt& sum) {
  Eigen::VectorXd left = Eigen::VectorXd::Zero(at.size());  // worths of items not yet placed
  for (auto item = ranking.rbegin(); item != ranking.rend(); ++item) {
    const auto placed = static_cast<Eigen::Index>(*item);
    left[placed] = std::exp(at[placed]);
    const Eigen::VectorXd shares = left / left.sum();
    sum.value += std::log(shares[placed]);
    sum.score += Eigen::VectorXd::Unit(at.size(), placed) - shares;
    sum.information += Eigen::MatrixXd{shares.asDiagonal()} - shares * shares.transpose();
  }
}
}  // namespace

bool is_ranking(Ranking ranking, std::size_t items) {
  std::ranges::sort(ranking);
  Ranking all(items);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return ranking == all;
}

PreferenceScale plackett_luce(const std::vector<Ranking>& rankings, std::size_t items) {
  for (const Ranking& ranking : rankings) {
    if (!is_ranking(ranking, items)) {
      throw core::InvalidInput{"a ranking holds every item once"};
    }
  }
  check_comparisons(pairs_of(rankings, items), TiesConnect::no);
  const auto count = static_cast<Eigen::Index>(items);
  const auto likelihood = [&](const Eigen::VectorXd& at) {
    LikelihoodAt sum{0.0, Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, count)};
    for (const Ranking& ranking : rankings) {
      add(ranking, at, sum);
    }
    return sum;
  };
  return scale_of(maximise_scale(likelihood, count, count), count);
}
}  // namespace tapstudy::analysis
