#include <fmt/format.h>

#include "analysis/blocks/html_parts.hpp"
#include "analysis/tables/table_writers.hpp"
#include "analysis/tables/tabular_summary.hpp"
#include "core/print.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::size_t wide = 8;  // columns

void write_cells(std::ostream& out, const ReportTable& table, const std::vector<std::size_t>& shown,
                 const std::vector<Cell>& row) {
  out << "<tr>";
  for (const std::size_t i : shown) {
    const bool is_first = i == shown.front();
    core::print(out, "<{}{}>{}</{}>", is_first ? "th scope=row" : "td",
                is_text_column(table, i) ? " class=text" : "", escaped_numbers(row[i].text),
                is_first ? "th" : "td");
  }
  out << "</tr>\n";
}
}  // namespace

void write_table_html(std::ostream& out, const ReportTable& table) {
  const std::vector<std::size_t> shown = shown_columns(table);
  core::print(out,
              "<h3>{0}</h3><div class=scroll tabindex=0 role=group aria-label=\"{0}\">"
              "<table class=\"data{1}\"><thead><tr>",
              escaped(table.title), shown.size() >= wide ? " wide" : "");
  for (const std::size_t i : shown) {
    core::print(out, "<th scope=col{}>{}</th>", is_text_column(table, i) ? " class=text" : "",
                escaped_numbers(table.columns[i].heading));
  }
  out << "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    write_cells(out, table, shown, row);
  }
  out << "</tbody></table></div>\n";
}

void TabularSummary::write_html(std::ostream& out) const {
  for (const ReportTable& table : parts) {
    if (!table.is_for_programs && !table.rows.empty()) {
      write_table_html(out, table);
    }
  }
  if (!charts.empty()) {
    out << "<div class=charts>\n";
    for (const Chart& chart : charts) {
      out << inline_svg(chart);
    }
    out << "</div>\n";
  }
  for (const std::string& remark : remarks) {
    core::print(out, "<p class=note>{}</p>\n", escaped(remark));
  }
  write_hypotheses_html(out, hypotheses);
}
}  // namespace tapstudy::analysis
