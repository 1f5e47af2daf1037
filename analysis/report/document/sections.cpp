#include "analysis/report/document/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "analysis/report/document/formats.hpp"
#include "core/text/print.hpp"
namespace tapstudy::analysis {
namespace {
bool is_shown(const ReportTable& table) {
  return !table.is_for_programs && !table.rows.empty();
}

bool has_content(const ReportSection& section) {
  return std::ranges::any_of(section.tables, is_shown) || !section.charts.empty() ||
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

void write_section(std::ostream& out, const ReportSection& section, const std::string& id) {
  core::print(out, "<section id=\"{}\"><h3>{}</h3>\n", escaped(id), escaped(section.title));
  for (const ReportTable& table : section.tables) {
    if (is_shown(table)) {
      write_table_html(out, table);
    }
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
  out << "</section>\n";
}
}  // namespace

void write_sections_text(std::ostream& out, const std::vector<ReportSection>& sections) {
  for (const ReportSection& section : sections) {
    if (!has_content(section)) {
      continue;
    }
    core::print(out, "\n{}\n\n", section.title);
    for (const ReportTable& table : section.tables) {
      if (is_shown(table)) {
        write_table_text(out, table);
      }
    }
    for (const std::string& remark : section.remarks) {
      out << wrapped(remark, 2);
    }
  }
}

void write_sections_html(std::ostream& out, const std::vector<ReportSection>& sections,
                         const std::string& anchor) {
  const auto id_of = [&](std::size_t i) { return fmt::format("{}-{}", anchor, i + 1); };
  const bool is_long = std::ranges::count_if(sections, has_content) > 1;
  if (is_long) {
    core::print(out, "<nav class=contents aria-label=\"Contents of {}\"><ul>\n", escaped(anchor));
  }
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (is_long && has_content(sections[i])) {
      core::print(out, "<li><a href=\"#{}\">{}</a></li>\n", escaped(id_of(i)),
                  escaped(sections[i].title));
    }
  }
  out << (is_long ? "</ul></nav>\n" : "");
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (has_content(sections[i])) {
      write_section(out, sections[i], id_of(i));
    }
  }
}

void add_sections(nlohmann::ordered_json& json, const std::vector<ReportSection>& sections) {
  auto remarks = nlohmann::ordered_json::array();
  for (const ReportSection& section : sections) {
    for (const ReportTable& table : section.tables) {
      json[table.name] = table_json(table);
    }
    for (const std::string& remark : section.remarks) {
      if (std::ranges::find(remarks, nlohmann::ordered_json(remark)) == remarks.end()) {
        remarks.push_back(remark);
      }
    }
  }
  json["remarks"] = remarks;
}

std::vector<CsvTable> csv_of(const std::vector<ReportSection>& sections) {
  std::vector<CsvTable> written;
  for (const ReportSection& section : sections) {
    for (const ReportTable& table : section.tables) {
      written.push_back(
          {table.name + ".csv", [&table](std::ostream& out) { write_table_csv(out, table); }});
    }
  }
  return written;
}
}  // namespace tapstudy::analysis
