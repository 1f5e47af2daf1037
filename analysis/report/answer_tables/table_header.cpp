#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "analysis/report/answer_tables/answer_table.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
// Whether every row below the header has so many cells.
bool have_cells(const CsvText& table, std::size_t number) {
  return table.rows.size() > 1 &&
         std::ranges::all_of(std::span{table.rows}.subspan(1),
                             [&](const CsvRow& row) { return row.cells.size() == number; });
}

void drop_further_headers(CsvText& table) {
  constexpr std::size_t import_row = 2;
  if (table.rows.size() > import_row &&
      std::ranges::all_of(table.rows[import_row].cells, [](const std::string& cell) {
        return cell.starts_with("{\"ImportId\"");
      })) {
    table.rows.erase(table.rows.begin() + 1, table.rows.begin() + 1 + import_row);
  }
}

void head_row_names(CsvText& table) {
  std::vector<std::string>& header = table.rows.front().cells;
  const bool ends_in_cells =
      std::ranges::any_of(std::span{table.rows}.subspan(1),
                          [](const CsvRow& row) { return !row.cells.back().empty(); });
  if (ends_in_cells && have_cells(table, header.size() + 1)) {
    header.insert(header.begin(), "");
  }
}

// What separates cells is told by the first row, so that below a title rows may be of one cell that
// holds the separators.
void check_is_no_title(const CsvText& table, const std::string& file) {
  if (table.rows.size() < 2) {
    return;
  }
  const CsvRow& first = table.rows.front();
  if (first.cells.front().find("*** Header Start ***") != std::string::npos) {
    throw core::InvalidInput{fmt::format(
        "{}: is E-Prime's own log: export it as a table by E-Merge or E-DataAid", file)};
  }
  const std::vector<std::string>& next = table.rows[1].cells;
  const bool is_header_next = next.size() > 2 && have_cells(table, next.size());
  const bool is_undivided =
      next.size() == 1 && next.front().find_first_of("\t;") != std::string::npos;
  if (first.cells.size() == 1 && (is_header_next || is_undivided)) {
    throw core::InvalidInput{
        fmt::format("{}: '{}' is no header of the rows below: leave out what stands above the "
                    "columns' names",
                    table.place(file, first.line), first.cells.front())};
  }
}
}  // namespace

void settle_header(CsvText& table, const std::string& file) {
  if (table.rows.empty()) {
    return;
  }
  drop_further_headers(table);
  check_is_no_title(table, file);
  head_row_names(table);
}
}  // namespace tapstudy::analysis
