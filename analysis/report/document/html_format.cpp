#include <fmt/format.h>

#include <string_view>

#include "analysis/report/document/formats.hpp"
#include "analysis/report/document/sections.hpp"
#include "analysis/report/document/wording.hpp"
#include "core/text/print.hpp"
namespace tapstudy::analysis {
std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string escaped_numbers(const std::string& text) {
  const std::string safe = escaped(text);
  std::string html;
  for (std::size_t i = 0; i < safe.size(); ++i) {
    const char before = i == 0 ? ' ' : safe[i - 1];
    const std::string_view rest = std::string_view{safe}.substr(i);
    if (is_minus(before, rest)) {
      html += "−";
    } else if (rest.starts_with(" %")) {
      html += "&nbsp;";
    } else {
      html += safe[i];
    }
  }
  return html;
}

std::string dot_plot(double share, const Interval& interval, double chance,
                     const std::string& alternative) {
  return fmt::format(
      R"(<svg class=dot viewBox="0 0 200 16" role=img aria-label="{}">)"
      "<line class=axis x1=0 y1=8 x2=200 y2=8 /><line class=chance x1={:.1f} y1=0 x2={:.1f} y2=16 "
      "/><line class=interval x1={:.1f} y1=8 x2={:.1f} y2=8 /><circle cx={:.1f} cy=8 r=4 /></svg>",
      escaped(alternative), 200 * chance, 200 * chance, 200 * interval.low, 200 * interval.high,
      200 * share);
}

std::string dot_plot(const Proportion& proportion, double chance) {
  return proportion.trials == 0 ? ""
                                : dot_plot(proportion.value(), wilson_interval(proportion), chance,
                                           with_interval(proportion));
}

void write_dot_row(std::ostream& out, const std::string& title, const std::string& words,
                   const std::string& dots) {
  core::print(out, "<tr><th scope=row>{}</th><td>{}</td><td>{}</td></tr>\n", escaped(title),
              escaped_numbers(words), dots);
}

void write_accuracy_row(std::ostream& out, const std::string& title, const Proportion& proportion,
                        double chance) {
  write_dot_row(out, title, with_interval(proportion), dot_plot(proportion, chance));
}

void write_hypotheses_html(std::ostream& out, const std::vector<HypothesisResult>& hypotheses) {
  if (hypotheses.empty()) {
    return;
  }
  out << "<h3>Declared before the study</h3><ul>\n";
  for (const HypothesisResult& result : hypotheses) {
    const std::string observed = result.p
                                     ? fmt::format("{} against {:.0f} % by chance; ",
                                                   fraction(result.observed), 100.0 * result.chance)
                                     : "";
    const std::string adjusted =
        result.p_holm ? fmt::format("; {} after Holm 1979", p_value(*result.p_holm)) : "";
    core::print(out, "<li>{} <b>{}</b> ({}{}{})</li>\n", escaped(result.planned.statement),
                escaped(p_value(result)), observed, escaped(result.test), escaped(adjusted));
  }
  out << "</ul>\n";
}

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
