#pragma once
#include <cstddef>
#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <vector>
namespace tapstudy::analysis {
struct CsvRow {
  int line{};  // of the file, from 1, where the row begins
  std::vector<std::string> cells;
};

struct CsvText {
  char separator{','};
  bool has_objects{false};            // instead of lines: of a list in JSON, counted from 1
  std::vector<std::string> comments;  // lines before the first row that start with #
  std::vector<CsvRow> rows;
  // A cell as a number; where commas do not separate cells, one is a decimal comma. Unset if it is
  // none.
  std::optional<double> number(std::string cell) const;
  // "file:3", or "file, object 3".
  std::string place(const std::string& file, int row) const;
};

// A count from 0, also where it is written as "3.0"; unset for what is none.
std::optional<std::int64_t> count_in_cell(const CsvText& table, const std::string& cell);

// All of a table's file. Throws InvalidInput beyond 64 MB, and as check_may_be_text().
std::string table_text(std::istream& text, const std::string& file);

// Comma-separated values (RFC 4180), or separated by tabulators or semicolons where the header has
// any, or by spaces where it has nothing but quoted names, as R's write.table has it: cells in
// double quotes may hold separators, quotes and line ends; spaces around other cells do not count;
// empty lines and a byte order mark are skipped. Between tabulators a quote that does not begin a
// cell is a character. Throws InvalidInput with file:line for a quote that is out of place or left
// open, for what is no UTF-8 text, and for a file beyond 64 MB. An apostrophe that guards a cell
// from being run as a formula is no part of it (core/text/spreadsheet_cell.hpp).
CsvText read_csv(std::istream& text, const std::string& file);

// What commas separate in an option of the command line, which has no header: a comma within a cell
// is in quotes, and a quote that does not begin a cell is a character. Throws as read_csv().
std::vector<std::string> cells_of_option(const std::string& text, const std::string& option);

// A cell as a file has it: in quotes if it needs them, guarded if a spreadsheet would run it.
std::string csv_cell(const std::string& text);
}  // namespace tapstudy::analysis
