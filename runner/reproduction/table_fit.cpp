#include "runner/reproduction/table_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "analysis/statistics/distributions.hpp"
#include "core/rng.hpp"
namespace tapstudy::runner {
namespace {
using Row = std::vector<std::int64_t>;
constexpr double added = 0.5;  // to each count (Jeffreys)

std::int64_t total_of(const Row& row) {
  return std::accumulate(row.begin(), row.end(), std::int64_t{0});
}

double log_multinomial(const Row& counts) {
  double sum = std::lgamma(static_cast<double>(total_of(counts)) + 1.0);
  for (const std::int64_t count : counts) {
    sum -= std::lgamma(static_cast<double>(count) + 1.0);
  }
  return sum;
}

double log_probability(const analysis::CountTable& counts, const Rows& rows,
                       const Probabilities& probabilities) {
  double sum = log_likelihood(counts, rows, probabilities);
  for (const std::size_t i : rows) {
    sum += log_multinomial(counts[i]);
  }
  return sum;
}

Row drawn(std::int64_t answers, const std::vector<double>& probabilities, core::Rng& rng) {
  Row row(probabilities.size(), 0);
  for (std::int64_t answer = 0; answer < answers; ++answer) {
    double left = rng.uniform();
    std::size_t j = 0;
    while (j + 1 < row.size() && left >= probabilities[j]) {
      left -= probabilities[j++];
    }
    ++row[j];
  }
  return row;
}
// Dirichlet: gamma variates over their sum.
std::vector<double> drawn_shares(const Row& answers, core::Rng& rng) {
  std::vector<double> shares;
  for (const std::int64_t count : answers) {
    const double uniform = std::max(rng.uniform(), std::numeric_limits<double>::min());
    shares.push_back(analysis::gamma_quantile(uniform, static_cast<double>(count) + added));
  }
  const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) {
    share /= all;
  }
  return shares;
}

// Of tables whose rows are drawn from these shares, as rare under the probabilities as the counts.
template <class SharesOf>
double share_as_rare(const analysis::CountTable& counts, const Rows& rows,
                     const Probabilities& probabilities, std::uint64_t seed, SharesOf shares_of) {
  constexpr int draws = 4000;
  constexpr double rounding = 1e-9;
  core::Rng rng{core::derived_seed(seed, core::Purpose::resampling)};
  const double observed = log_probability(counts, rows, probabilities);
  analysis::CountTable table = counts;
  int as_rare = 0;
  for (int draw = 0; draw < draws; ++draw) {
    for (const std::size_t i : rows) {
      table[i] = drawn(total_of(counts[i]), shares_of(i, rng), rng);
    }
    as_rare += log_probability(table, rows, probabilities) <= observed + rounding ? 1 : 0;
  }
  return (as_rare + 1.0) / (draws + 1.0);
}
}  // namespace

Probabilities probabilities_of(const analysis::CountTable& answers) {
  Probabilities probabilities;
  for (const Row& row : answers) {
    const double all = static_cast<double>(total_of(row)) + added * static_cast<double>(row.size());
    std::vector<double> shares;
    for (const std::int64_t count : row) {
      shares.push_back((static_cast<double>(count) + added) / all);
    }
    probabilities.push_back(shares);
  }
  return probabilities;
}

double log_likelihood(const analysis::CountTable& counts, const Rows& rows,
                      const Probabilities& probabilities) {
  double sum = 0.0;
  for (const std::size_t i : rows) {
    for (std::size_t j = 0; j < counts[i].size(); ++j) {
      sum += static_cast<double>(counts[i][j]) * std::log(probabilities[i][j]);
    }
  }
  return sum;
}

double multinomial_p(const analysis::CountTable& counts, const Rows& rows,
                     const Probabilities& probabilities, std::uint64_t seed) {
  return share_as_rare(counts, rows, probabilities, seed,
                       [&](std::size_t row, core::Rng& /*rng*/) { return probabilities[row]; });
}

double predictive_p(const analysis::CountTable& counts, const Rows& rows,
                    const analysis::CountTable& answers, std::uint64_t seed) {
  return share_as_rare(
      counts, rows, probabilities_of(answers), seed,
      [&](std::size_t row, core::Rng& rng) { return drawn_shares(answers[row], rng); });
}
}  // namespace tapstudy::runner
