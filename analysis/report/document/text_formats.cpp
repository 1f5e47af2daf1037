#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>

#include "analysis/report/document/formats.hpp"
#include "analysis/report/document/sections.hpp"
#include "analysis/report/document/wording.hpp"
#include "analysis/statistics/csv_rows.hpp"
#include "core/text/print.hpp"
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

bool has_rows_of_participants(const ReportTable& table) {
  return !table.columns.empty() && table.columns.front().heading.words == "participant";
}

bool is_text_column(const ReportTable& table, std::size_t column) {
  return !table.rows.empty() && std::ranges::all_of(table.rows, [&](const auto& row) {
    return is_nothing(row[column]) || is_word(row[column]);
  });
}

std::size_t text_width(const std::string& text) {
  constexpr int marks = 0xC0;  // the bytes of a character after its first are 10xxxxxx
  constexpr int continued = 0x80;
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char byte) { return (byte & marks) != continued; }));
}

std::vector<std::string> lines_of(const std::string& text, std::size_t width, std::size_t hanging) {
  std::istringstream words{text};
  std::vector<std::string> lines;
  for (std::string word; words >> word;) {
    if (lines.empty()) {
      lines.push_back(word);
    } else if (text_width(lines.back()) + 1 + text_width(word) > width) {
      lines.push_back(std::string(hanging, ' ') + word);
    } else {
      lines.back() += ' ' + word;
    }
  }
  return lines;
}

std::string wrapped(const std::string& text, std::size_t indent) {
  std::string all;
  for (const std::string& line : lines_of(text, terminal_columns - indent, 2)) {
    all += std::string(indent, ' ') + line + '\n';
  }
  return all;
}

void write_hypotheses_text(std::ostream& out, const std::vector<HypothesisResult>& hypotheses) {
  for (const HypothesisResult& result : hypotheses) {
    const std::string adjusted =
        result.p_holm ? fmt::format(", {} after {}", p_value(*result.p_holm), "Holm 1979"_source)
                      : "";
    out << wrapped(result.planned.statement, 2)
        << wrapped(result.p ? fmt::format("{}: {} ({}){}", finding_of(result), p_value(result),
                                          result.test, adjusted)
                            : "not tested: " + result.test,
                   4);
  }
}

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
    const Column& column = table.columns[i];
    grid.headings.push_back(!table.is_matrix ? column.heading.words
                            : i == 0         ? "presented \\ answered"
                                             : column.keys.front());
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      const Cell& cell = table.rows[row][i];
      grid.rows[row].push_back(
          table.is_matrix && i == 0 ? std::get<std::string>(cell.values.front()) : cell.text.words);
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
void write_entry(std::ostream& out, const std::vector<std::string>& headings,
                 const std::vector<std::string>& row) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    out << wrapped(fmt::format("{}: {}", headings[i], row[i]), i == 0 ? 2 : 4);
  }
}
}  // namespace

void write_table_text(std::ostream& out, const ReportTable& table, std::size_t most_lines) {
  const Grid grid = grid_of(table);
  const std::vector<std::size_t> widths = widths_of(grid);
  std::size_t total = 0;
  for (const std::size_t width : widths) {
    total += width + 2;
  }
  out << wrapped(table.title, 2);
  const bool is_wide = total > terminal_columns && !table.is_matrix;
  const std::size_t lines_of_row = is_wide ? std::max<std::size_t>(1, widths.size()) : 1;
  const std::size_t most_rows = has_rows_of_participants(table)
                                    ? std::max<std::size_t>(1, most_lines / lines_of_row)
                                    : all_lines;
  if (!is_wide) {
    write_line(out, grid.headings, widths);
  }
  const std::size_t shown = std::min(grid.rows.size(), most_rows);
  for (const auto& row : std::span{grid.rows}.first(shown)) {
    is_wide ? write_entry(out, grid.headings, row) : write_line(out, row, widths);
  }
  if (shown < grid.rows.size()) {
    core::print(out, "  … and {} more (--all; {} in the files)\n", grid.rows.size() - shown,
                table.name);
  }
  out << '\n';
}

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

namespace {
// What LaTeX reads as commands, and what its text fonts lack.
constexpr std::array<std::pair<std::string_view, std::string_view>, 22> replacements{
    {{"\\", "\\textbackslash{}"},
     {"^", "\\textasciicircum{}"},
     {"~", "\\textasciitilde{}"},
     {"#", "\\#"},
     {"$", "\\$"},
     {"%", "\\%"},
     {"&", "\\&"},
     {"_", "\\_"},
     {"{", "\\{"},
     {"}", "\\}"},
     {"–", "--"},
     {"²", "\\textsuperscript{2}"},
     {"±", "$\\pm$"},
     {"×", "$\\times$"},
     {"∞", "$\\infty$"},
     {"η", "$\\eta$"},
     {"χ", "$\\chi$"},
     {"κ", "$\\kappa$"},
     {"<", "$<$"},
     {">", "$>$"},
     {"≤", "$\\leq$"},
     {"\n", " "}}};
}  // namespace

std::string latex_text(std::string_view text) {
  std::string safe;
  while (!text.empty()) {
    if (is_minus(safe.empty() ? ' ' : safe.back(), text)) {
      safe += "$-$";
      text.remove_prefix(1);
    }
    const auto found = std::ranges::find_if(
        replacements, [&](const auto& each) { return text.starts_with(each.first); });
    const bool is_known = found != replacements.end();
    safe += is_known ? found->second : text.substr(0, 1);
    text.remove_prefix(is_known ? found->first.size() : 1);
  }
  return safe;
}

void write_table_latex(std::ostream& out, const ReportTable& table, const std::string& label) {
  const std::vector<std::size_t> shown = shown_columns(table);
  std::string alignment;
  for (const std::size_t column : shown) {
    alignment += column == shown.front() || is_text_column(table, column) ? 'l' : 'r';
  }
  core::print(out,
              "\\begin{{table}}[htbp]\n\\centering\n\\caption{{{}}}\n\\label{{tab:{}}}\n"
              "\\begin{{tabular}}{{{}}}\n\\toprule\n",
              latex_text(table.title.words), label, alignment);
  const auto write_row = [&](const auto& text_of) {
    const std::string& first = text_of(shown.front());
    out << (first.starts_with('[') || first.starts_with('*') ? "{}" : "");  // no option of the line
    for (const std::size_t column : shown) {
      core::print(out, "{}{}", column == shown.front() ? "" : " & ", latex_text(text_of(column)));
    }
    out << " \\\\\n";
  };
  write_row(
      [&](std::size_t column) -> const std::string& { return table.columns[column].heading; });
  out << "\\midrule\n";
  for (const std::vector<Cell>& row : table.rows) {
    write_row([&](std::size_t column) -> const std::string& { return row[column].text; });
  }
  out << "\\bottomrule\n\\end{tabular}\n\\end{table}\n";
}
}  // namespace tapstudy::analysis
