#include "analysis/statistics/contingency/agreement.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
std::optional<Kappa> cohens_kappa(const CountTable& table) {
  const TableTotals totals = totals_of_square(table);
  if (totals.all == 0) {
    return std::nullopt;
  }
  const auto n = static_cast<double>(totals.all);
  const auto row = [&](std::size_t i) { return static_cast<double>(totals.rows[i]) / n; };
  const auto column = [&](std::size_t j) { return static_cast<double>(totals.columns[j]) / n; };
  double agreed = 0.0;
  double by_chance = 0.0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    agreed += static_cast<double>(table[i][i]) / n;
    by_chance += row(i) * column(i);
  }
  if (1.0 - by_chance < 1e-12) {
    return std::nullopt;
  }
  const double kappa = (agreed - by_chance) / (1.0 - by_chance);
  double on_diagonal = 0.0;
  double off_diagonal = 0.0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (std::size_t j = 0; j < table.size(); ++j) {
      const double p = static_cast<double>(table[i][j]) / n;
      const double weight = i == j ? 1.0 - (row(i) + column(i)) * (1.0 - kappa)
                                   : (column(i) + row(j)) * (1.0 - kappa);
      (i == j ? on_diagonal : off_diagonal) += p * weight * weight;
    }
  }
  const double bias = kappa - by_chance * (1.0 - kappa);
  const double variance =
      (on_diagonal + off_diagonal - bias * bias) / (n * (1.0 - by_chance) * (1.0 - by_chance));
  const double error = std::sqrt(std::max(0.0, variance));
  const double reach = normal_quantile(0.975) * error;
  return Kappa{kappa, error, {std::max(-1.0, kappa - reach), std::min(1.0, kappa + reach)}};
}

std::optional<ChiSquaredTest> bowker_test(const CountTable& table) {
  totals_of_square(table);
  double sum = 0.0;
  int pairs = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (std::size_t j = i + 1; j < table.size(); ++j) {
      const auto confused = static_cast<double>(table[i][j] + table[j][i]);
      const auto difference = static_cast<double>(table[i][j] - table[j][i]);
      sum += confused > 0.0 ? difference * difference / confused : 0.0;
      pairs += confused > 0.0 ? 1 : 0;
    }
  }
  if (pairs == 0) {
    return std::nullopt;
  }
  return ChiSquaredTest{sum, static_cast<double>(pairs), chi_squared_p(sum, pairs)};
}

std::optional<ChiSquaredTest> stuart_maxwell_test(const CountTable& table) {
  const TableTotals totals = totals_of_square(table);
  const auto size = static_cast<Eigen::Index>(table.size());
  Eigen::VectorXd difference(size);
  Eigen::MatrixXd covariance(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const auto row = static_cast<std::size_t>(i);
    difference(i) = static_cast<double>(totals.rows[row] - totals.columns[row]);
    for (Eigen::Index j = 0; j < size; ++j) {
      const auto column = static_cast<std::size_t>(j);
      covariance(i, j) =
          i == j ? static_cast<double>(totals.rows[row] + totals.columns[row] - 2 * table[row][row])
                 : -static_cast<double>(table[row][column] + table[column][row]);
    }
  }
  // The whole matrix is singular, for differences add up to 0: within its range the inverse gives
  // the same as without one class.
  const core::EigenPairs pairs = core::symmetric_eigenpairs(covariance);
  const double largest = std::max(pairs.values.maxCoeff(), 0.0);
  const Eigen::VectorXd along = pairs.vectors.transpose() * difference;
  double sum = 0.0;
  int rank = 0;
  for (Eigen::Index i = 0; i < size; ++i) {
    if (pairs.values(i) > 1e-10 * largest) {
      sum += along(i) * along(i) / pairs.values(i);
      ++rank;
    }
  }
  if (rank == 0) {
    return std::nullopt;
  }
  return ChiSquaredTest{sum, static_cast<double>(rank), chi_squared_p(sum, rank)};
}

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
