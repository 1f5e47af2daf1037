#include "analysis/agreement/symmetry.hpp"

#include <algorithm>

#include "analysis/statistics/distributions.hpp"
#include "core/algebra/lapack.hpp"
namespace tapstudy::analysis {
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
}  // namespace tapstudy::analysis
