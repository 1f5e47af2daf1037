#include "analysis/agreement/kappa.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/distributions.hpp"
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
}  // namespace tapstudy::analysis
