#include "analysis/statistics/contingency/agreement.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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

namespace {
// The rates of a square table and the covariance of each row of them, 0 in rows never presented.
struct Rates {
  Eigen::MatrixXd of_answers;
  std::vector<Eigen::MatrixXd> covariances;
};

Rates rates_of(const CountTable& table) {
  const TableTotals totals = totals_of_square(table);
  const auto size = static_cast<Eigen::Index>(table.size());
  Eigen::MatrixXd counts(size, size);
  Eigen::VectorXd presented(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    presented(i) = static_cast<double>(totals.rows[static_cast<std::size_t>(i)]);
    for (Eigen::Index j = 0; j < size; ++j) {
      counts(i, j) =
          static_cast<double>(table[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]);
    }
  }
  Rates rates{Eigen::MatrixXd::Zero(size, size), {table.size(), Eigen::MatrixXd::Zero(size, size)}};
  for (Eigen::Index i = 0; i < size; ++i) {
    if (presented(i) == 0.0) {
      continue;
    }
    rates.of_answers.row(i) = counts.row(i) / presented(i);
    Eigen::VectorXd symmetric =
        (counts.row(i).transpose() + counts.col(i)).array() / (presented.array() + presented(i));
    symmetric(i) = 0.0;
    symmetric(i) = std::max(0.0, 1.0 - symmetric.sum());
    // the sum is 1 unless a class is named so often that no symmetric rates are as near
    rates.covariances[static_cast<std::size_t>(i)] =
        (symmetric.sum() * Eigen::MatrixXd{symmetric.asDiagonal()} -
         symmetric * symmetric.transpose()) /
        presented(i);
  }
  return rates;
}

std::optional<ChiSquaredTest> is_zero_test(const Eigen::VectorXd& difference,
                                           const Eigen::MatrixXd& covariance) {
  const core::EigenPairs pairs = core::symmetric_eigenpairs(covariance);
  const Eigen::VectorXd along = pairs.vectors.transpose() * difference;
  const double least = 1e-10 * pairs.values.maxCoeff();
  double sum = 0.0;
  int rank = 0;
  for (Eigen::Index i = 0; i < difference.size(); ++i) {
    if (pairs.values(i) > std::max(least, 0.0)) {
      sum += along(i) * along(i) / pairs.values(i);
      ++rank;
    }
  }
  if (rank == 0) {
    return std::nullopt;
  }
  return ChiSquaredTest{sum, static_cast<double>(rank), chi_squared_p(sum, rank)};
}

// Pairs of classes, both presented, of which one was answered with the other.
std::vector<std::pair<std::size_t, std::size_t>> confused_pairs(const CountTable& table,
                                                                const TableTotals& totals) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (std::size_t j = i + 1; j < table.size(); ++j) {
      if (totals.rows[i] > 0 && totals.rows[j] > 0 && table[i][j] + table[j][i] > 0) {
        pairs.emplace_back(i, j);
      }
    }
  }
  return pairs;
}
}  // namespace

std::optional<ChiSquaredTest> symmetry_test(const CountTable& table) {
  const Rates rates = rates_of(table);
  const auto pairs = confused_pairs(table, totals_of(table));
  if (pairs.empty()) {
    return std::nullopt;
  }
  const auto count = static_cast<Eigen::Index>(pairs.size());
  Eigen::VectorXd difference(count);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(count, count);
  // How the difference of a pair depends on the row's rates: by its column and a sign; 0 if not.
  const auto in_row = [&](Eigen::Index pair, std::size_t row) -> std::pair<Eigen::Index, double> {
    const auto [first, second] = pairs[static_cast<std::size_t>(pair)];
    if (row == first) {
      return {static_cast<Eigen::Index>(second), 1.0};
    }
    return {static_cast<Eigen::Index>(first), row == second ? -1.0 : 0.0};
  };
  for (Eigen::Index a = 0; a < count; ++a) {
    difference(a) = 0.0;
    for (std::size_t row = 0; row < table.size(); ++row) {
      const auto [column, sign] = in_row(a, row);
      difference(a) += sign * rates.of_answers(static_cast<Eigen::Index>(row), column);
      for (Eigen::Index b = 0; b < count; ++b) {
        const auto [other_column, other_sign] = in_row(b, row);
        covariance(a, b) += sign * other_sign * rates.covariances[row](column, other_column);
      }
    }
  }
  return is_zero_test(difference, covariance);
}

std::optional<ChiSquaredTest> homogeneity_test(const CountTable& table) {
  const Rates rates = rates_of(table);
  const auto size = static_cast<Eigen::Index>(table.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  for (const Eigen::MatrixXd& of_row : rates.covariances) {
    covariance += of_row;
  }
  const Eigen::VectorXd presented = rates.of_answers.rowwise().sum();  // 1, or 0
  return is_zero_test(rates.of_answers.colwise().sum().transpose() - presented, covariance);
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
