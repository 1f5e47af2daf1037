#include <fmt/format.h>

#include <cmath>

#include "analysis/statistics/csv_rows.hpp"
#include "analysis/tables/table_writers.hpp"
#include "analysis/tables/tabular_summary.hpp"
namespace tapstudy::analysis {
namespace {
struct ToCsv {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(bool is_so) const { return is_so ? "true" : "false"; }
  std::string operator()(double value) const {
    return std::isnan(value) ? "" : fmt::format("{}", value);
  }
  std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
  std::string operator()(const std::string& text) const { return csv_cell(text); }
};

}  // namespace

void write_table_csv(std::ostream& out, const ReportTable& table) {
  const char* separator = "";
  for (const Column& column : table.columns) {
    for (const std::string& key : column.keys) {
      out << separator << csv_cell(key);
      separator = ",";
    }
  }
  out << '\n';
  for (const auto& row : table.rows) {
    separator = "";
    for (const Cell& cell : row) {
      for (const Value& value : cell.values) {
        out << separator << std::visit(ToCsv{}, value);
        separator = ",";
      }
    }
    out << '\n';
  }
}

std::vector<CsvTable> TabularSummary::tables() const {
  std::vector<CsvTable> written;
  for (const ReportTable& table : parts) {
    written.push_back(
        {table.name + ".csv", [&table](std::ostream& out) { write_table_csv(out, table); }});
  }
  return written;
}
}  // namespace tapstudy::analysis
