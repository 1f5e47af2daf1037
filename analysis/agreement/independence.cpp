#include "analysis/agreement/independence.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/resampling/replicates.hpp"
#include "analysis/statistics/distributions.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
double pearson(const CountTable& table, const TableTotals& totals) {
  double sum = 0.0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (std::size_t j = 0; j < table[i].size(); ++j) {
      const double expected = static_cast<double>(totals.rows[i]) *
                              static_cast<double>(totals.columns[j]) /
                              static_cast<double>(totals.all);
      const double difference = static_cast<double>(table[i][j]) - expected;
      sum += expected > 0.0 ? difference * difference / expected : 0.0;
    }
  }
  return sum;
}

double likelihood_ratio(const CountTable& table, const TableTotals& totals) {
  double sum = 0.0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (std::size_t j = 0; j < table[i].size(); ++j) {
      const auto n = static_cast<double>(table[i][j]);
      if (n > 0.0) {
        sum += 2.0 * n *
               std::log(n * static_cast<double>(totals.all) / static_cast<double>(totals.rows[i]) /
                        static_cast<double>(totals.columns[j]));
      }
    }
  }
  return sum;
}
}  // namespace

std::optional<Independence> independence(const CountTable& table) {
  const CountTable full = without_empty_lines(table);
  if (full.size() < 2 || full.front().size() < 2) {
    return std::nullopt;
  }
  const TableTotals totals = totals_of(full);
  Independence result;
  result.chi_squared = pearson(full, totals);
  result.g_squared = likelihood_ratio(full, totals);
  const auto rows = static_cast<double>(full.size());
  const auto columns = static_cast<double>(full.front().size());
  result.degrees_of_freedom = (rows - 1.0) * (columns - 1.0);
  result.asymptotic_p = chi_squared_p(result.chi_squared, result.degrees_of_freedom);
  result.cramers_v = std::sqrt(result.chi_squared / static_cast<double>(totals.all) /
                               (std::min(rows, columns) - 1.0));
  return result;
}

std::vector<std::vector<double>> adjusted_residuals(const CountTable& table) {
  const TableTotals totals = totals_of(table);
  const auto n = static_cast<double>(totals.all);
  std::vector<std::vector<double>> residuals;
  for (std::size_t i = 0; i < table.size(); ++i) {
    residuals.emplace_back();
    for (std::size_t j = 0; j < table[i].size(); ++j) {
      const auto row = static_cast<double>(totals.rows[i]);
      const auto column = static_cast<double>(totals.columns[j]);
      const double expected = n > 0.0 ? row * column / n : 0.0;
      const double variance = n > 0.0 ? expected * (1.0 - row / n) * (1.0 - column / n) : 0.0;
      residuals.back().push_back(variance > 0.0 ? (static_cast<double>(table[i][j]) - expected) /
                                                      std::sqrt(variance)
                                                : 0.0);
    }
  }
  return residuals;
}

MonteCarloTest monte_carlo_independence(const NullTables& tables, int draws, std::uint64_t seed,
                                        unsigned threads) {
  if (draws < 1) {
    throw core::InvalidInput{"a null distribution takes one draw or more"};
  }
  const auto drawn = replicates(
      draws,
      [&](std::uint64_t own_seed) {
        const CountTable table = tables.draw(own_seed);
        return pearson(table, totals_of(table));
      },
      seed, threads);
  return {monte_carlo_p(drawn, pearson(tables.observed, totals_of(tables.observed))), draws};
}
}  // namespace tapstudy::analysis
