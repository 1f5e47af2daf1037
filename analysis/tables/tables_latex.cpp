#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "analysis/tables/minus_sign.hpp"
#include "analysis/tables/table_writers.hpp"
#include "core/print.hpp"
namespace tapstudy::analysis {
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
              latex_text(table.title), label, alignment);
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
