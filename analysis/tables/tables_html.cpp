#include <fmt/format.h>

#include "analysis/blocks/html_parts.hpp"
#include "analysis/tables/table_writers.hpp"
#include "analysis/tables/tabular_summary.hpp"
#include "core/print.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::size_t wide = 8;  // columns

struct ShownColumn {
  std::size_t index{};
  const char* style{};  // an attribute
  std::string heading;
};

std::vector<ShownColumn> styled_columns(const ReportTable& table) {
  std::vector<ShownColumn> styled;
  for (const std::size_t i : shown_columns(table)) {
    styled.push_back({i, is_text_column(table, i) ? " class=text" : "",
                      escaped_numbers(table.columns[i].heading)});
  }
  return styled;
}

// On a phone a row is a list, each cell with its heading before it.
void write_cells(std::ostream& out, const std::vector<ShownColumn>& shown,
                 const std::vector<Cell>& row) {
  out << "<tr>";
  bool is_first = true;
  for (const ShownColumn& column : shown) {
    const std::string text = escaped_numbers(row[column.index].text);
    if (is_first) {
      core::print(out, "<th scope=row{}>{}</th>", column.style, text);
    } else {
      core::print(out, "<td{} data-heading=\"{}\">{}</td>", column.style, column.heading, text);
    }
    is_first = false;
  }
  out << "</tr>\n";
}
}  // namespace

void write_table_html(std::ostream& out, const ReportTable& table) {
  const std::vector<ShownColumn> shown = styled_columns(table);
  core::print(out,
              "<h3>{0}</h3><div class=scroll tabindex=0 role=group aria-label=\"{0}\">"
              "<table class=\"data{1}\"><thead><tr>",
              escaped(table.title), shown.size() >= wide ? " wide" : "");
  for (const ShownColumn& column : shown) {
    core::print(out, "<th scope=col{}>{}</th>", column.style, column.heading);
  }
  out << "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    write_cells(out, shown, row);
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
