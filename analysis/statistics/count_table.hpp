#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>
namespace tapstudy::analysis {
// counts[row][column], none negative, all rows as long.
using CountTable = std::vector<std::vector<std::int64_t>>;

struct TableTotals {
  std::vector<std::int64_t> rows;
  std::vector<std::int64_t> columns;
  std::int64_t all{};
};
// Throws InvalidInput for a table without cells, with rows of different lengths, or with a count
// below 0.
TableTotals totals_of(const CountTable& table);

// Without the rows and columns whose total is 0.
CountTable without_empty_lines(const CountTable& table);

// Cell by cell. Throws InvalidInput if their shapes differ or there is none.
CountTable sum_of(const std::vector<CountTable>& tables);

// Throws InvalidInput, as totals_of does, and if there are not as many rows as columns.
TableTotals totals_of_square(const CountTable& table);
}  // namespace tapstudy::analysis
