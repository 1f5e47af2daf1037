#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>

#include "analysis/report/document/formats.hpp"
#include "analysis/report/document/sections.hpp"
#include "analysis/report/document/wording.hpp"
#include "analysis/report/html_style.hpp"
#include "core/text/print.hpp"
namespace tapstudy::analysis {
std::string escaped(const std::string& text) {
  constexpr std::string_view special = "&<>\"";
  constexpr std::array<std::string_view, 4> entities{"&amp;", "&lt;", "&gt;", "&quot;"};
  std::string safe;
  for (const char c : text) {
    const std::size_t place = special.find(c);
    safe += place == std::string_view::npos ? std::string_view{&c, 1} : entities.at(place);
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

namespace {
std::string dot_plot(const Dot& dot, const std::string& alternative) {
  return fmt::format(
      R"(<svg class=dot viewBox="0 0 200 16" role=img aria-label="{}">)"
      "<line class=axis x1=0 y1=8 x2=200 y2=8 /><line class=chance x1={:.1f} y1=0 x2={:.1f} y2=16 "
      "/><line class=interval x1={:.1f} y1=8 x2={:.1f} y2=8 /><circle cx={:.1f} cy=8 r=4 /></svg>",
      escaped(alternative), 200 * dot.chance, 200 * dot.chance, 200 * dot.interval.low,
      200 * dot.interval.high, 200 * dot.share);
}
}  // namespace

namespace {
constexpr std::size_t wide = 8;  // columns

struct ShownColumn {
  std::size_t index{};
  const char* style{};  // an attribute
  std::string heading;
  bool has_dots{};
};

std::vector<ShownColumn> styled_columns(const ReportTable& table) {
  std::vector<ShownColumn> styled;
  for (const std::size_t i : shown_columns(table)) {
    styled.push_back(
        {i, is_text_column(table, i) ? " class=text" : "",
         escaped_numbers(table.columns[i].heading),
         std::ranges::any_of(table.rows, [&](const auto& row) { return row[i].dot.has_value(); })});
  }
  return styled;
}

// On a phone a row is a list, each cell with its heading before it.
void write_cells(std::ostream& out, const std::vector<ShownColumn>& shown,
                 const std::vector<Cell>& row) {
  out << "<tr>";
  bool is_first = true;
  for (const ShownColumn& column : shown) {
    const Cell& cell = row[column.index];
    std::string text = escaped_numbers(cell.text);
    if (!cell.anchor.empty()) {
      text = fmt::format("<a href=\"#{}\">{}</a>", escaped(cell.anchor), text);
    }
    if (!cell.style.empty()) {
      text = fmt::format("<span class=\"{}\">{}</span>", cell.style, text);
    }
    if (is_first) {
      core::print(out, "<th scope=row{}>{}</th>", column.style, text);
    } else {
      core::print(out, "<td{} data-heading=\"{}\">{}</td>", column.style, column.heading, text);
    }
    if (column.has_dots) {
      core::print(out, "<td>{}</td>", cell.dot ? dot_plot(*cell.dot, cell.text) : "");
    }
    is_first = false;
  }
  out << "</tr>\n";
}

// The relative luminance of a colour in sRGB, which the contrast ratio is made of (WCAG 2.1).
double luminance(const std::array<int, 3>& colour) {
  constexpr std::array<double, 3> weights{0.2126, 0.7152, 0.0722};
  double sum = 0.0;
  for (std::size_t i = 0; i < colour.size(); ++i) {
    const double part = colour[i] / 255.0;
    sum += weights[i] * (part <= 0.03928 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4));
  }
  return sum;
}

// The ground goes from white to deep blue; the text is white or black, whichever contrasts more.
std::string cell_style(double share) {
  const double x = std::sqrt(share);
  const auto mix = [&](int from, int to) {
    return static_cast<int>(std::lround(from + x * (to - from)));
  };
  const std::array<int, 3> colour{mix(247, 8), mix(251, 69), mix(255, 148)};
  const double ground = luminance(colour) + 0.05;
  return fmt::format("background:rgb({},{},{});color:{}", colour[0], colour[1], colour[2],
                     1.05 / ground > ground / 0.05 ? "#fff" : "#000");
}

void write_matrix_html(std::ostream& out, const ReportTable& table) {
  out << "<div class=scroll tabindex=0 role=group aria-label=\"Confusion matrix\">"
         "<table class=matrix><caption>Rows: presented. Columns: answered. Each cell: count and "
         "share of its row.</caption><thead><tr><td></td>";
  const std::vector<std::size_t> shown = shown_columns(table);
  const std::span<const std::size_t> counts = std::span{shown}.subspan(1);
  for (const std::size_t column : counts) {
    core::print(out, "<th scope=col>{}</th>", escaped(table.columns[column].heading));
  }
  out << "<th class=total scope=col>n</th></tr></thead><tbody>\n";
  for (const std::vector<Cell>& row : table.rows) {
    core::print(out, "<tr><th scope=row>{}</th>", escaped(row[shown.front()].text));
    std::int64_t total = 0;
    for (const std::size_t column : counts) {
      total += std::get<std::int64_t>(row[column].values.front());
    }
    for (const std::size_t column : counts) {
      const Proportion cell{std::get<std::int64_t>(row[column].values.front()), total};
      core::print(out, R"(<td class="{}" style="{}"><b>{}</b><span>{}</span></td>)",
                  row[column].style, cell_style(total == 0 ? 0.0 : cell.value()), cell.successes,
                  percent(cell));
    }
    core::print(out, "<td class=total>{}</td></tr>\n", total);
  }
  out << "</tbody></table></div>\n";
}
}  // namespace

void write_framed_html(std::ostream& out, const ReportTable& table) {
  const std::vector<ShownColumn> shown = styled_columns(table);
  const bool has_dots = std::ranges::any_of(shown, &ShownColumn::has_dots);
  core::print(out,
              "<div class=scroll tabindex=0 role=group aria-label=\"{}\">"
              "<table class=\"{}\"><thead><tr>",
              escaped(table.title),
              has_dots               ? "accuracy"
              : shown.size() >= wide ? "data wide"
                                     : "data");
  for (const ShownColumn& column : shown) {
    core::print(out, "<th scope=col{}>{}</th>{}", column.style, column.heading,
                column.has_dots ? "<td></td>" : "");
  }
  out << "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    write_cells(out, shown, row);
  }
  out << "</tbody></table></div>\n";
}

void write_table_html(std::ostream& out, const ReportTable& table) {
  if (table.is_matrix) {
    write_matrix_html(out, table);
    return;
  }
  constexpr std::size_t most_people = 5;
  const bool is_folded = has_rows_of_participants(table) && table.rows.size() > most_people;
  const std::string heading = fmt::format("<h3>{}</h3>", escaped(table.title));
  out << (is_folded ? "<details><summary>" + heading + "</summary>" : heading);
  write_framed_html(out, table);
  out << (is_folded ? "</details>\n" : "");
  if (!table.note.empty()) {
    core::print(out, "<p class=note>{}</p>\n", escaped(table.note));
  }
}

void begin_page(std::ostream& out, const std::string& title, const std::string& more_style) {
  core::print(
      out,
      "<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><meta name=viewport "
      "content=\"width=device-width\"><title>{0}</title><style>{1}{2}</style></head><body><main>\n"
      "<h1>{0}</h1>\n",
      escaped(title), html_style, more_style);
}

void end_page(std::ostream& out,
              const std::vector<std::pair<std::string, std::string>>& provenance) {
  if (!provenance.empty()) {
    out << "<h2>Provenance</h2><table class=provenance>\n";
    for (const auto& [key, value] : provenance) {
      core::print(out, "<tr><th scope=row>{}</th><td>{}</td></tr>\n", escaped(key), escaped(value));
    }
    out << "</table>\n";
  }
  out << "</main></body></html>\n";
}
}  // namespace tapstudy::analysis
