#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/resampling/replicates.hpp"
#include "analysis/similarity/similarity_choice.hpp"
#include "core/rng.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::int64_t most_answers = 5000;
constexpr int draws = 999;

// A Markov chain over the tables of the same totals of rows, columns and pairs; each has its
// conditional probability under quasi-symmetry, proportional to 1 / product of n_ij!.
class Chain {
 public:
  Chain(const CountTable& table, core::Rng& rng) : table_{table}, order_(table.size()), rng_{rng} {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
  }

  // All that differs between the tables of G²: sum of n ln n.
  double statistic() const {
    double sum = 0.0;
    for (const auto& row : table_) {
      for (const std::int64_t count : row) {
        sum += count > 0 ? static_cast<double>(count) * std::log(static_cast<double>(count)) : 0.0;
      }
    }
    return sum;
  }

  void step() {
    const std::size_t most = std::min<std::size_t>(order_.size(), longest_cycle);
    const std::size_t length = 3 + rng_.below(static_cast<std::uint32_t>(most - 2));
    for (std::size_t i = 0; i < length; ++i) {  // the first ones of a shuffle
      std::swap(order_[i], order_[i + rng_.below(static_cast<std::uint32_t>(order_.size() - i))]);
    }
    double ratio = 1.0;  // of probabilities
    for (std::size_t i = 0; i < length; ++i) {
      const std::size_t from = order_[i];
      const std::size_t to = order_[(i + 1) % length];
      ratio *= static_cast<double>(table_[to][from]) / static_cast<double>(table_[from][to] + 1);
    }
    if (rng_.uniform() >= ratio) {
      return;
    }
    for (std::size_t i = 0; i < length; ++i) {
      const std::size_t from = order_[i];
      const std::size_t to = order_[(i + 1) % length];
      ++table_[from][to];
      --table_[to][from];
    }
  }

 private:
  static constexpr std::size_t longest_cycle = 6;
  CountTable table_;
  std::vector<std::size_t> order_;
  core::Rng& rng_;
};

std::vector<double> statistics_of(const CountTable& table, int count, std::int64_t steps_between,
                                  core::Rng& rng) {
  Chain chain{table, rng};
  std::vector<double> statistics;
  for (int draw = 0; draw < count; ++draw) {
    for (std::int64_t step = 0; step < steps_between; ++step) {
      chain.step();
    }
    statistics.push_back(chain.statistic());
  }
  return statistics;
}
}  // namespace

ConditionalFit conditional_fit(const CountTable& table, const SimilarityChoice& model,
                               std::uint64_t seed) {
  const TableTotals totals = totals_of_square(table);
  if (totals.all > most_answers || table.size() < 3) {
    return {model.p, 0};
  }
  core::Rng rng{core::derived_seed(seed, core::Purpose::resampling)};
  const auto steps = std::max<std::int64_t>(100, totals.all);
  // the chain is reversible: backward is as forward
  const auto after = static_cast<int>(rng.below(draws + 1));
  std::vector<double> drawn = statistics_of(table, after, steps, rng);
  const std::vector<double> before = statistics_of(table, draws - after, steps, rng);
  drawn.insert(drawn.end(), before.begin(), before.end());
  return {monte_carlo_p(drawn, Chain{table, rng}.statistic()), draws};
}
}  // namespace tapstudy::analysis
