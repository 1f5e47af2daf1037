#include "analysis/report/writers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "analysis/report/answer_tables/counts_csv.hpp"
#include "analysis/report/document/formats.hpp"
#include "analysis/report/document/sections.hpp"
#include "analysis/report/html_style.hpp"
#include "analysis/report/references.hpp"
#include "core/text/print.hpp"
namespace tapstudy::analysis {
void write_text(std::ostream& out, const Summary& summary) {
  core::print(out, "{}\n", summary.title);
  if (const std::string warning = banner(summary); !warning.empty()) {
    core::print(out, "{}\n", warning);
  }
  for (const std::string& session : summary.unfinished) {
    core::print(out, "unfinished: {}\n", session);
  }
  for (const std::string& participant : summary.excluded) {
    core::print(out, "excluded by the operator: {}\n", participant);
  }
  for (const std::string& deviation : summary.deviations) {
    core::print(out, "note: {}\n", deviation);
  }
  for (const auto& block : summary.blocks) {
    core::print(out, "\n");
    if (!block->block.empty()) {
      core::print(out, "{}: {}\n\n", block->block, block->question);
    }
    block->write_text(out);
  }
  std::vector<ReportSection> shown = summary.sections;
  if (!summary.blocks.empty()) {
    std::erase_if(shown, [](const ReportSection& section) { return section.is_detail; });
  }
  write_sections_text(out, shown);
}

namespace {
// Links to the blocks and to the study as a whole, where there are two or more.
void write_contents(std::ostream& out, const Summary& summary) {
  if (summary.blocks.size() + (summary.sections.empty() ? 0 : 1) < 2) {
    return;
  }
  out << "<nav class=contents aria-label=Blocks><ul>\n";
  for (const auto& block : summary.blocks) {
    core::print(out, "<li><a href=\"#block-{0}\">{0}</a></li>\n", escaped(block->block));
  }
  if (!summary.sections.empty()) {
    out << "<li><a href=\"#study\">The study as a whole</a></li>\n";
  }
  out << "</ul></nav>\n";
}
// Ampersands as they are cited.
std::string text_of(const std::string& html) {
  std::string text = html;
  constexpr std::string_view escape{"&amp;"};
  for (auto at = text.find(escape); at != std::string::npos; at = text.find(escape, at + 1)) {
    text.replace(at, escape.size(), "&");
  }
  return text;
}

std::string body_of(const Summary& summary) {
  std::ostringstream body;
  write_contents(body, summary);
  for (const auto& block : summary.blocks) {
    if (block->block.empty()) {
      body << "<h2>Answers</h2>\n";
    } else {
      core::print(body, "<h2 id=\"block-{0}\">{0}</h2>\n<p>{1}</p>\n", escaped(block->block),
                  escaped(block->question));
    }
    block->write_html(body);
  }
  if (!summary.sections.empty()) {
    body << "<h2 id=\"study\">The study as a whole</h2>\n";
    write_sections_html(body, summary.sections, "study");
  }
  core::print(body, "<h2>Methods</h2><p>{}</p>\n", escaped(methods(summary)));
  return body.str();
}

void write_references(std::ostream& out, const std::vector<std::string>& cited) {
  if (cited.empty()) {
    return;
  }
  out << "<h2>References</h2>\n<ul class=references>\n";
  for (const std::string& reference : cited) {
    core::print(out, "<li>{}</li>\n", escaped(reference));
  }
  out << "</ul>\n";
}
}  // namespace

std::vector<std::string> references_of(const Summary& summary) {
  return references_in(text_of(body_of(summary)));
}

void write_html(std::ostream& out, const Summary& summary) {
  core::print(
      out,
      "<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><meta name=viewport "
      "content=\"width=device-width\"><title>{}</title><style>{}</style></head><body><main>\n"
      "<h1>{}</h1>\n",
      escaped(summary.title), html_style, escaped(summary.title));
  if (const std::string warning = banner(summary); !warning.empty()) {
    core::print(out, "<p class=simulated>{}</p>\n", escaped(warning));
  }
  if (!summary.unfinished.empty()) {
    core::print(out, "<p>Unfinished sessions: {}.</p>\n",
                escaped(fmt::format("{}", fmt::join(summary.unfinished, "; "))));
  }
  if (!summary.excluded.empty()) {
    core::print(out, "<p>Excluded by the operator: {}.</p>\n",
                escaped(fmt::format("{}", fmt::join(summary.excluded, "; "))));
  }
  if (!summary.deviations.empty()) {
    core::print(out, "<p>Notes: {}.</p>\n",
                escaped(fmt::format("{}", fmt::join(summary.deviations, "; "))));
  }
  const std::string body = body_of(summary);
  out << body;
  write_references(out, references_in(text_of(body)));
  if (!summary.notes.empty()) {
    core::print(out, "<h2>Notes of the protocol</h2><p class=notes>{}</p>\n",
                escaped(summary.notes));
  }
  if (!summary.provenance.empty()) {
    out << "<h2>Provenance</h2><table class=provenance>\n";
    for (const auto& [key, value] : summary.provenance) {
      core::print(out, "<tr><th scope=row>{}</th><td>{}</td></tr>\n", escaped(key), escaped(value));
    }
    out << "</table>\n";
  }
  out << "</main></body></html>\n";
}

using Json = nlohmann::ordered_json;
namespace {
// A file's name need not be UTF-8.
std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}
}  // namespace

void write_json(std::ostream& out, const Summary& summary) {
  Json json{{"schema_version", 1},
            {"title", summary.title},
            {"modes", words_of_modes(summary)},
            {"participants", summary.participants}};
  json["unfinished"] = summary.unfinished;
  json["excluded"] = summary.excluded;
  json["deviations"] = summary.deviations;
  json["blocks"] = Json::array();
  for (const auto& block : summary.blocks) {
    json["blocks"].push_back(block->as_json());
  }
  if (!summary.sections.empty()) {
    json["study"] = Json::object();
    add_sections(json["study"], summary.sections);
  }
  if (summary.loop) {
    json["loop"] = {
        {"ticks", summary.loop->ticks},     {"late", summary.loop->late},
        {"skipped", summary.loop->skipped}, {"dropped_samples", summary.loop->dropped_samples},
        {"impacts", summary.loop->impacts}, {"late_impacts", summary.loop->late_impacts}};
  }
  json["provenance"] = Json::object();
  for (const auto& [key, value] : summary.provenance) {
    json["provenance"][key] = value;
  }
  json["methods"] = methods(summary);
  json["references"] = references_of(summary);
  out << text_of(json, 2) << '\n';
}

namespace {
// Of letters, digits and hyphens.
std::string label_of(const std::string& block, const std::string& table) {
  std::string label = block.empty() ? table : block + "-" + table;
  std::ranges::replace_if(
      label, [](unsigned char c) { return c > 127 || std::isalnum(c) == 0; }, '-');
  return label;
}

void write_tables(std::ostream& out, const std::string& block,
                  const std::vector<ReportTable>& tables) {
  for (const ReportTable& table : tables) {
    if (!table.is_for_programs && !table.rows.empty()) {
      out << '\n';
      write_table_latex(out, table, label_of(block, table.name));
    }
  }
}
}  // namespace

void write_latex(std::ostream& out, const Summary& summary) {
  out << "% Each table to be copied or \\input; they take \\usepackage{booktabs} and UTF-8.\n";
  core::print(out, "% {}\n", latex_text(summary.title));
  if (const std::string warning = banner(summary); !warning.empty()) {
    core::print(out, "% {}\n", warning);
  }
  for (const auto& block : summary.blocks) {
    write_tables(out, block->block, block->report_tables());
  }
  for (const ReportSection& section : summary.sections) {
    write_tables(out, "", section.tables);
  }
}

namespace {
std::string file_word(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return c > 127 || (std::isalnum(c) == 0 && c != '-'); }, '_');
  return text;
}

class Namer {
 public:
  // With a number where figures would share a name.
  std::string operator()(const std::string& wanted) {
    std::string name = file_word(wanted);
    for (int number = 2; !taken_.insert(name).second; ++number) {
      name = fmt::format("{}_{}", file_word(wanted), number);
    }
    return name;
  }

 private:
  std::set<std::string> taken_;
};
}  // namespace

std::vector<FigureFile> figure_files(const Summary& summary) {
  const std::string mark = banner(summary).empty() ? "" : words_of_modes(summary);
  std::vector<FigureFile> files;
  Namer named;
  const auto add = [&](const std::string& where, const std::vector<Chart>& charts) {
    for (std::size_t i = 0; i < charts.size(); ++i) {
      const std::string own =
          charts[i].name.empty() ? fmt::format("figure_{}", i + 1) : charts[i].name;
      files.push_back(
          {named(where.empty() ? own : where + "_" + own), standalone_svg(charts[i], mark)});
    }
  };
  for (const auto& block : summary.blocks) {
    add(block->block, block->figures());
  }
  for (const ReportSection& section : summary.sections) {
    add(section.name, section.charts);
    add(section.name, section.folded_charts);
  }
  return files;
}

namespace {
std::string text_of(const Summary& summary, const CsvTable& table) {
  std::ostringstream text;
  if (!banner(summary).empty()) {
    text << mode_mark << words_of_modes(summary) << '\n';
  }
  table.write(text);
  return text.str();
}
}  // namespace

// A block may have a name that makes its tables those of a section, or of another block.
std::vector<TableFile> table_files(const Summary& summary) {
  std::vector<TableFile> files;
  std::set<std::string> taken;
  for (const CsvTable& table : csv_of(summary.sections)) {
    taken.insert(table.name);
  }
  for (const auto& block : summary.blocks) {
    for (const CsvTable& table : block->tables()) {
      std::string name = block->block.empty() ? table.name : block->block + "_" + table.name;
      while (!taken.insert(name).second) {
        name = "block_" + name;
      }
      files.push_back({name, text_of(summary, table)});
    }
  }
  for (const CsvTable& table : csv_of(summary.sections)) {
    files.push_back({table.name, text_of(summary, table)});
  }
  return files;
}
}  // namespace tapstudy::analysis
