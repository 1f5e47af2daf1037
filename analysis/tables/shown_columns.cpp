#include <algorithm>

#include "analysis/tables/table_writers.hpp"
namespace tapstudy::analysis {
namespace {
bool is_nothing(const Cell& cell) {
  return cell.text.empty() || cell.text == "–";
}

bool is_word(const Cell& cell) {
  return cell.values.size() == 1 && std::holds_alternative<std::string>(cell.values.front());
}
}  // namespace

std::vector<std::size_t> shown_columns(const ReportTable& table) {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const bool is_empty =
        !table.rows.empty() &&
        std::ranges::all_of(table.rows, [&](const auto& row) { return is_nothing(row[i]); });
    if (!table.columns[i].heading.empty() && !is_empty) {
      shown.push_back(i);
    }
  }
  return shown;
}

bool is_text_column(const ReportTable& table, std::size_t column) {
  return !table.rows.empty() && std::ranges::all_of(table.rows, [&](const auto& row) {
    return is_nothing(row[column]) || is_word(row[column]);
  });
}
}  // namespace tapstudy::analysis
