#include <fmt/format.h>

#include "analysis/blocks/html_parts.hpp"
#include "analysis/tables/table_writers.hpp"
#include "analysis/tables/tabular_summary.hpp"
#include "core/print.hpp"
namespace tapstudy::analysis {
namespace {
void write_row(std::ostream& out, const ReportTable& table, const std::vector<Cell>& row) {
  out << "<tr>";
  bool is_first = true;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (table.columns[i].heading.empty()) {
      continue;
    }
    core::print(out, "{}{}{}", is_first ? "<th scope=row>" : "<td>", escaped(row[i].text),
                is_first ? "</th>" : "</td>");
    is_first = false;
  }
  out << "</tr>\n";
}

}  // namespace

void write_table_html(std::ostream& out, const ReportTable& table) {
  core::print(out,
              "<h3>{0}</h3><div class=scroll tabindex=0 role=group aria-label=\"{0}\">"
              "<table class=data><thead><tr>",
              escaped(table.title));
  for (const Column& column : table.columns) {
    if (!column.heading.empty()) {
      core::print(out, "<th scope=col>{}</th>", escaped(column.heading));
    }
  }
  out << "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    write_row(out, table, row);
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
