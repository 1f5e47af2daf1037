#include "analysis/statistics/count_table.hpp"

#include "core/error.hpp"
namespace tapstudy::analysis {
TableTotals totals_of(const CountTable& table) {
  if (table.empty() || table.front().empty()) {
    throw core::InvalidInput{"a table of counts has one row and one column or more"};
  }
  TableTotals totals{std::vector<std::int64_t>(table.size()),
                     std::vector<std::int64_t>(table.front().size()), 0};
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].size() != totals.columns.size()) {
      throw core::InvalidInput{"the rows of a table of counts are of one length"};
    }
    for (std::size_t j = 0; j < table[i].size(); ++j) {
      if (table[i][j] < 0) {
        throw core::InvalidInput{"counts are not below 0"};
      }
      totals.rows[i] += table[i][j];
      totals.columns[j] += table[i][j];
      totals.all += table[i][j];
    }
  }
  return totals;
}

CountTable without_empty_lines(const CountTable& table) {
  const TableTotals totals = totals_of(table);
  CountTable kept;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (totals.rows[i] == 0) {
      continue;
    }
    kept.emplace_back();
    for (std::size_t j = 0; j < table[i].size(); ++j) {
      if (totals.columns[j] > 0) {
        kept.back().push_back(table[i][j]);
      }
    }
  }
  return kept;
}

CountTable sum_of(const std::vector<CountTable>& tables) {
  if (tables.empty()) {
    throw core::InvalidInput{"a sum of tables takes one table or more"};
  }
  CountTable sum = tables.front();
  for (std::size_t t = 1; t < tables.size(); ++t) {
    if (tables[t].size() != sum.size()) {
      throw core::InvalidInput{"tables that are added have one shape"};
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
      if (tables[t][i].size() != sum[i].size()) {
        throw core::InvalidInput{"tables that are added have one shape"};
      }
      for (std::size_t j = 0; j < sum[i].size(); ++j) {
        sum[i][j] += tables[t][i][j];
      }
    }
  }
  return sum;
}

TableTotals totals_of_square(const CountTable& table) {
  TableTotals totals = totals_of(table);
  if (totals.rows.size() != totals.columns.size()) {
    throw core::InvalidInput{"this table of counts has as many rows as columns"};
  }
  return totals;
}
}  // namespace tapstudy::analysis
