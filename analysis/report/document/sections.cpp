#include "analysis/report/document/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "analysis/report/document/formats.hpp"
#include "core/text/print.hpp"
namespace tapstudy::analysis {
std::vector<const ReportTable*> tables_shown(const ReportSection& section, bool ShownIn::*format) {
  std::vector<const ReportTable*> shown;
  for (const ReportTable& table : section.tables) {
    if (table.shown_in.*format && !table.rows.empty() && !shown_columns(table).empty()) {
      shown.push_back(&table);
    }
  }
  return shown;
}

namespace {
bool has_content(const ReportSection& section) {
  return !tables_shown(section, &ShownIn::page).empty() || !section.charts.empty() ||
         !section.remarks.empty();
}

void write_charts(std::ostream& out, const std::vector<Chart>& charts) {
  if (charts.empty()) {
    return;
  }
  out << "<div class=charts>\n";
  for (const Chart& chart : charts) {
    out << inline_svg(chart);
  }
  out << "</div>\n";
}

void add_to(std::set<core::Source>& sources, const CitingText& text) {
  sources.insert(text.sources.begin(), text.sources.end());
}
}  // namespace

void write_contents_html(std::ostream& out, const ReportSection& section) {
  for (const ReportTable* const table : tables_shown(section, &ShownIn::page)) {
    write_table_html(out, *table);
  }
  write_charts(out, section.charts);
  if (!section.folded_charts.empty()) {
    core::print(out, "<details><summary>More figures ({})</summary>\n",
                section.folded_charts.size());
    write_charts(out, section.folded_charts);
    out << "</details>\n";
  }
  for (const std::string& remark : section.remarks) {
    core::print(out, "<p class=note>{}</p>\n", escaped(remark));
  }
}

void write_contents_text(std::ostream& out, const ReportSection& section, std::size_t most_lines) {
  for (const ReportTable* const table : tables_shown(section, &ShownIn::text)) {
    write_table_text(out, *table, most_lines);
  }
  for (const std::string& line : section.terminal_lines) {
    out << wrapped(line, 2);
  }
  for (const std::string& remark : section.remarks) {
    out << wrapped(remark, 2);
  }
}

void write_sections_text(std::ostream& out, std::span<const ReportSection> sections,
                         std::size_t most_lines) {
  for (const ReportSection& section : sections) {
    if (has_content(section)) {
      core::print(out, "\n{}\n\n", section.title);
      write_contents_text(out, section, most_lines);
    }
  }
}

namespace {
// No name of a block, with its anchor before it, is that of a section.
std::string section_anchor(const std::string& anchor, std::size_t place) {
  return escaped(fmt::format("section-{}-{}", anchor, place + 1));
}
}  // namespace

std::string section_links(std::span<const ReportSection> sections, const std::string& anchor) {
  std::string links;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (has_content(sections[i])) {
      links += fmt::format(" <a href=\"#{}\">{}</a>", section_anchor(anchor, i),
                           escaped(sections[i].title));
    }
  }
  return links;
}

// The anchor is within what is folded, since browsers open what is around a link's target.
void write_sections_html(std::ostream& out, std::span<const ReportSection> sections,
                         const std::string& anchor, bool are_folded) {
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (has_content(sections[i])) {
      const std::string heading = fmt::format("<h3>{}</h3>", escaped(sections[i].title));
      core::print(out, "<{}>{}<a class=anchor id=\"{}\"></a>\n",
                  are_folded ? "details class=section" : "section",
                  are_folded ? "<summary>" + heading + "</summary>" : heading,
                  section_anchor(anchor, i));
      write_contents_html(out, sections[i]);
      out << (are_folded ? "</details>\n" : "</section>\n");
    }
  }
}

void add_sections(nlohmann::ordered_json& json, const std::vector<ReportSection>& sections) {
  auto remarks = nlohmann::ordered_json::array();
  for (const ReportSection& section : sections) {
    for (const ReportTable& table : section.tables) {
      if (table.shown_in.json) {
        json[table.name] = table_json(table);
      }
    }
    for (const std::string& remark : section.remarks) {
      if (std::ranges::find(remarks, nlohmann::ordered_json(remark)) == remarks.end()) {
        remarks.push_back(remark);
      }
    }
  }
  json["remarks"] = remarks;
}

std::vector<const ReportTable*> csv_tables(const std::vector<ReportSection>& sections) {
  std::vector<const ReportTable*> written;
  for (const ReportSection& section : sections) {
    for (const ReportTable& table : section.tables) {
      if (table.shown_in.csv) {
        written.push_back(&table);
      }
    }
  }
  return written;
}

void add_sources(std::set<core::Source>& sources, const ReportSection& section) {
  for (const ReportTable* const table : tables_shown(section, &ShownIn::page)) {
    add_to(sources, table->title);
    add_to(sources, table->note);
    for (const std::size_t column : shown_columns(*table)) {
      add_to(sources, table->columns[column].heading);
      for (const auto& row : table->rows) {
        add_to(sources, row[column].text);
      }
    }
  }
  for (const auto* const charts : {&section.charts, &section.folded_charts}) {
    for (const Chart& chart : *charts) {
      add_to(sources, chart.caption);
    }
  }
  for (const CitingText& remark : section.remarks) {
    add_to(sources, remark);
  }
}
}  // namespace tapstudy::analysis
