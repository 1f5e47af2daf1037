#include "analysis/resampling/random_table.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/log_factorial.hpp"
namespace tapstudy::analysis {
namespace {
double log_hypergeometric(std::int64_t k, std::int64_t marked, std::int64_t drawn,
                          std::int64_t population) {
  const auto log_ways = [](std::int64_t n, std::int64_t of) {
    return log_factorial(n) - log_factorial(of) - log_factorial(n - of);
  };
  return log_ways(marked, k) + log_ways(population - marked, drawn - k) -
         log_ways(population, drawn);
}
}  // namespace

std::int64_t random_hypergeometric(std::int64_t marked, std::int64_t drawn, std::int64_t population,
                                   core::Rng& rng) {
  const std::int64_t least = std::max<std::int64_t>(0, drawn - (population - marked));
  const std::int64_t most = std::min(drawn, marked);
  if (least == most) {
    return least;
  }
  const double mode_at = static_cast<double>(drawn + 1) * static_cast<double>(marked + 1) /
                         static_cast<double>(population + 2);
  const std::int64_t mode = std::clamp(static_cast<std::int64_t>(mode_at), least, most);
  // p(k + 1) / p(k)
  const auto ratio = [&](std::int64_t k) {
    return static_cast<double>(marked - k) * static_cast<double>(drawn - k) /
           (static_cast<double>(k + 1) * static_cast<double>(population - marked - drawn + k + 1));
  };
  double p_above = std::exp(log_hypergeometric(mode, marked, drawn, population));
  double p_below = p_above;
  double left = rng.uniform() - p_above;
  std::int64_t above = mode;
  std::int64_t below = mode;
  while (left >= 0.0 && (above < most || below > least)) {
    if (above < most) {
      p_above *= ratio(above);
      ++above;
      left -= p_above;
      if (left < 0.0) {
        return above;
      }
    }
    if (below > least) {
      --below;
      p_below /= ratio(below);
      left -= p_below;
      if (left < 0.0) {
        return below;
      }
    }
  }
  return mode;
}

CountTable random_table(const TableTotals& totals, core::Rng& rng) {
  CountTable table(totals.rows.size(), std::vector<std::int64_t>(totals.columns.size(), 0));
  std::vector<std::int64_t> left = totals.columns;  // of each column
  std::int64_t all_left = totals.all;
  for (std::size_t i = 0; i < table.size(); ++i) {
    std::int64_t row_left = totals.rows[i];
    std::int64_t population = all_left;
    for (std::size_t j = 0; j < left.size(); ++j) {
      const std::int64_t cell = random_hypergeometric(left[j], row_left, population, rng);
      table[i][j] = cell;
      population -= left[j];
      row_left -= cell;
      left[j] -= cell;
    }
    all_left -= totals.rows[i];
  }
  return table;
}

CountTable sum_of_random_tables(const std::vector<TableTotals>& totals, core::Rng& rng) {
  std::vector<CountTable> tables;
  tables.reserve(totals.size());
  for (const TableTotals& of_table : totals) {
    tables.push_back(random_table(of_table, rng));
  }
  return sum_of(tables);
}

std::size_t work_of_random_tables(const std::vector<CountTable>& tables) {
  constexpr double work_of_a_cell = 10.0;
  double cells = 0.0;
  double answers = 0.0;
  for (const CountTable& table : tables) {
    const TableTotals totals = totals_of(table);
    cells += static_cast<double>(totals.rows.size() * totals.columns.size());
    answers += static_cast<double>(totals.all);
  }
  return static_cast<std::size_t>(cells * work_of_a_cell + std::sqrt(answers * cells));
}
}  // namespace tapstudy::analysis
