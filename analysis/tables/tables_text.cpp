#include <fmt/format.h>

#include <algorithm>

#include "analysis/blocks/text_parts.hpp"
#include "analysis/tables/table_writers.hpp"
#include "analysis/tables/tabular_summary.hpp"
#include "core/print.hpp"
namespace tapstudy::analysis {
namespace {
// What people see of a table.
struct Grid {
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> rows;
};

Grid grid_of(const ReportTable& table) {
  Grid grid;
  grid.rows.resize(table.rows.size());
  for (const std::size_t i : shown_columns(table)) {
    grid.headings.push_back(table.columns[i].heading);
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      grid.rows[row].push_back(table.rows[row][i].text);
    }
  }
  return grid;
}

std::vector<std::size_t> widths_of(const Grid& grid) {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < grid.headings.size(); ++i) {
    std::size_t widest = text_width(grid.headings[i]);
    for (const auto& row : grid.rows) {
      widest = std::max(widest, text_width(row[i]));
    }
    widths.push_back(widest);
  }
  return widths;
}

void write_line(std::ostream& out, const std::vector<std::string>& cells,
                const std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string space(widths[i] - text_width(cells[i]), ' ');
    line += i == 0 ? "  " + cells[i] + space : "  " + space + cells[i];
  }
  core::print(out, "{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
}

// A table that is too wide: one entry below another.
void write_entries(std::ostream& out, const Grid& grid) {
  for (const auto& row : grid.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string entry = fmt::format("{}: {}", grid.headings[i], row[i]);
      out << wrapped(entry, i == 0 ? 2 : 4);
    }
  }
}

}  // namespace

void write_table_text(std::ostream& out, const ReportTable& table) {
  const Grid grid = grid_of(table);
  const std::vector<std::size_t> widths = widths_of(grid);
  std::size_t total = 0;
  for (const std::size_t width : widths) {
    total += width + 2;
  }
  out << wrapped(table.title, 2);
  if (total > terminal_columns) {
    write_entries(out, grid);
  } else {
    write_line(out, grid.headings, widths);
    for (const auto& row : grid.rows) {
      write_line(out, row, widths);
    }
  }
  out << '\n';
}

void TabularSummary::write_text(std::ostream& out) const {
  for (const ReportTable& table : parts) {
    if (!table.is_for_programs && !table.rows.empty()) {
      write_table_text(out, table);
    }
  }
  for (const std::string& remark : remarks) {
    out << wrapped(remark, 2);
  }
  write_hypotheses_text(out, hypotheses);
}
}  // namespace tapstudy::analysis
