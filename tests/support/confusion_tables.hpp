#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "analysis/statistics/confusion_matrix.hpp"
#include "core/random/rng.hpp"
namespace tapstudy::testing {
using analysis::CountTable;

// Table 2 of the paper (protocols/paper/table2.csv).
inline CountTable paper_table() {
  return {{10, 5, 2, 3}, {7, 10, 3, 0}, {1, 3, 11, 5}, {1, 2, 5, 12}};
}
inline CountTable table_with_zeros() {
  return {{9, 1, 0, 0}, {3, 6, 1, 0}, {0, 2, 7, 1}, {0, 0, 4, 6}};
}
inline CountTable table_with_a_class_never_answered() {
  return {{6, 0, 4}, {5, 0, 5}, {1, 0, 9}};
}
inline CountTable table_of_one_answer() {
  return {{0, 1}, {0, 0}};
}
inline CountTable large_random_table() {
  core::Rng rng{11};
  CountTable table(7, std::vector<std::int64_t>(7));
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (std::size_t j = 0; j < table.size(); ++j) {
      table[i][j] = static_cast<std::int64_t>(rng.below(900) + (i == j ? 4000U : 1U));
    }
  }
  return table;
}
// Those with answers enough for every statistic.
inline std::vector<CountTable> ordinary_tables() {
  return {paper_table(), table_with_zeros(), large_random_table(), {{8, 3}, {2, 5}}};
}
inline std::vector<CountTable> all_tables() {
  auto tables = ordinary_tables();
  tables.push_back(table_with_a_class_never_answered());
  tables.push_back(table_of_one_answer());
  return tables;
}

// R's matrix of a table, and numpy's.
inline std::string r_matrix(const CountTable& table) {
  std::string cells;
  for (const auto& row : table) {
    cells += fmt::format("{}{}", cells.empty() ? "" : ",", fmt::join(row, ","));
  }
  return fmt::format("matrix(c({}), nrow = {}, byrow = TRUE)", cells, table.size());
}
inline std::string python_matrix(const CountTable& table) {
  return fmt::format("np.array({})", table);
}
}  // namespace tapstudy::testing
