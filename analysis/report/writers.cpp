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
#include "analysis/report/document/wording.hpp"
#include "core/text/print.hpp"
namespace tapstudy::analysis {
namespace {
// Whose data these are, and what was not as planned.
void write_head(std::ostream& out, const Summary& summary) {
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
}
}  // namespace

void write_text(std::ostream& out, const Summary& summary, std::size_t most_lines) {
  write_head(out, summary);
  for (const auto& block : summary.blocks) {
    core::print(out, "\n");
    if (!block->block.empty()) {
      core::print(out, "{}: {}\n\n", block->block, block->question);
    }
    block->write_text(out, most_lines);
  }
  for (const ReportSection& section : summary.sections) {
    if (summary.blocks.empty() || !section.is_detail || most_lines == all_lines) {
      write_sections_text(out, {&section, 1}, most_lines);
    }
  }
}

namespace {
std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

std::string first_table(const ReportSection& section, std::size_t most_lines) {
  std::ostringstream text;
  const auto tables = tables_shown(section, &ShownIn::text);
  if (!tables.empty()) {
    write_table_text(text, *tables.front(), most_lines);
  }
  return text.str();
}

// What a block was made to find out, and what was declared about it.
std::string findings_of(const BlockSummary& block) {
  std::ostringstream text;
  if (!block.block.empty()) {
    core::print(text, "\n{}: {}\n", block.block, block.question);
  }
  for (const MainResult& result : block.main_results) {
    text << wrapped(in_words(result, block.number_who_answered()), 2);
  }
  write_hypotheses_text(text, block.hypotheses);
  return text.str();
}

// Those that there is room for.
std::vector<std::string> first_findings(const ReportSection& section) {
  constexpr std::size_t most = 3;
  std::vector<std::string> first{section.findings.begin(),
                                 section.findings.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                most, section.findings.size()))};
  if (first.size() < section.findings.size()) {
    first.emplace_back("the others stand in the tables");
  }
  return first;
}

std::string findings_of(const ReportSection& section) {
  std::string text = section.findings.empty() ? "" : fmt::format("\n{}\n", section.title);
  for (const std::string& finding : first_findings(section)) {
    text += wrapped(finding, 2);
  }
  return text;
}

// The first of each: comparisons of blocks and groups whose findings are not told in words, blocks.
std::vector<std::string> first_tables(const Summary& summary, std::size_t most_lines) {
  std::vector<std::string> tables;
  for (const ReportSection& section : summary.sections) {
    if (const std::string table = first_table(section, most_lines);
        !section.is_detail && section.findings.empty() && !table.empty()) {
      tables.push_back(fmt::format("\n{}\n{}", section.title, table));
    }
  }
  for (const auto& block : summary.blocks) {
    tables.push_back(
        fmt::format("\n{}\n{}", block->block, first_table(block->results(), most_lines)));
  }
  return tables;
}
}  // namespace

void write_text_within(std::ostream& out, const Summary& summary, std::size_t lines,
                       std::size_t most_lines) {
  std::ostringstream whole;
  write_text(whole, summary, most_lines);
  const std::size_t all = lines_of(whole.str());
  if (all <= lines) {
    out << whole.str();
    return;
  }
  std::ostringstream text;
  write_head(text, summary);
  for (const auto& block : summary.blocks) {
    text << findings_of(*block);
  }
  for (const ReportSection& section : summary.sections) {
    text << findings_of(section);
  }
  const std::string left =
      fmt::format("\nall {} lines: --all; figures and methods: report.html\n", all);
  std::string shown = text.str();
  for (const std::string& table : first_tables(summary, most_lines)) {
    if (lines_of(shown + table + left) <= lines) {
      shown += table;
    }
  }
  for (std::size_t at = 0, line = 0; line + lines_of(left) < lines && at < shown.size(); ++line) {
    const std::size_t end = std::min(shown.size(), shown.find('\n', at) + 1);
    out << shown.substr(at, end - at);
    at = end;
  }
  out << left;
}

namespace {
std::string heading_of(const BlockSummary& block) {
  return block.block.empty() ? "Answers" : escaped(block.block);
}

// Links to every part of the page, folded ones too, in its order; of several blocks folded, so that
// the first figure is seen at once.
void write_contents(std::ostream& out, const Summary& summary) {
  const bool is_folded = summary.blocks.size() > 1;
  out << "<nav class=contents aria-label=Contents>"
      << (is_folded ? "<details><summary>Contents</summary>" : "") << "<ul>\n";
  for (const auto& block : summary.blocks) {
    core::print(out, "<li><a href=\"#{}\"><b>{}</b></a>{}</li>\n", escaped(block->anchor()),
                heading_of(*block), block->details_links());
  }
  out << "<li><a href=\"#methods\"><b>Methods</b></a>";
  if (!summary.sections.empty()) {
    core::print(out, " <a href=\"#study\"><b>The study as a whole</b></a>{}",
                section_links(summary.sections, "study"));
  }
  out << "</li></ul>" << (is_folded ? "</details>" : "") << "</nav>\n";
}

void write_body(std::ostream& body, const Summary& summary) {
  write_contents(body, summary);
  for (const auto& block : summary.blocks) {
    core::print(body, "<h2 id=\"{}\">{}</h2>\n", escaped(block->anchor()), heading_of(*block));
    if (summary.blocks.size() > 1) {
      core::print(body, "<p>{}</p>\n", escaped(block->question));
    }
    block->write_html(body);
  }
  core::print(body, "<h2 id=methods>Methods</h2><p>{}</p>\n", escaped(methods(summary)));
  for (const auto& block : summary.blocks) {
    if (!block->details_links().empty()) {
      core::print(body, "<h2>{}: what else the answers say</h2>\n", heading_of(*block));
      block->write_details_html(body);
    }
  }
  if (!summary.sections.empty()) {
    body << "<h2 id=study>The study as a whole</h2>\n";
    write_sections_html(body, summary.sections, "study",
                        !summary.blocks.empty() || summary.sections.size() > 1);
  }
}

void write_references(std::ostream& out, const std::vector<std::string>& cited) {
  if (cited.empty()) {
    return;
  }
  core::print(out,
              "<details class=section><summary><h3>References ({})</h3></summary>\n"
              "<ul class=references>\n",
              cited.size());
  for (const std::string& reference : cited) {
    core::print(out, "<li>{}</li>\n", escaped(reference));
  }
  out << "</ul></details>\n";
}
}  // namespace

std::vector<std::string> references_of(const Summary& summary) {
  const std::vector<core::Source> of_methods = methods(summary).sources;
  std::set<core::Source> cited{of_methods.begin(), of_methods.end()};
  for (const auto& block : summary.blocks) {
    cited.merge(block->sources());
  }
  for (const ReportSection& section : summary.sections) {
    add_sources(cited, section);
  }
  std::vector<std::string> references;
  for (const core::Source& source : cited) {
    references.emplace_back(source.reference().full);
  }
  return references;
}

namespace {
// "12 participants, 2 more excluded, 1 session unfinished."
std::string people_in_words(const Summary& summary) {
  std::string words =
      fmt::format("{} participant{}", summary.participants, summary.participants == 1 ? "" : "s");
  if (!summary.excluded.empty()) {
    words += fmt::format(", {} more excluded", summary.excluded.size());
  }
  if (!summary.unfinished.empty()) {
    words += fmt::format(", {} session{} unfinished", summary.unfinished.size(),
                         summary.unfinished.size() == 1 ? "" : "s");
  }
  return words + ".";
}
}  // namespace

namespace {
void write_findings_html(std::ostream& out, const ReportSection& section) {
  if (!section.findings.empty()) {
    core::print(out, "<p><b>{}</b> (exploratory): {}.</p>\n", escaped(section.title),
                escaped_numbers(fmt::format("{}", fmt::join(first_findings(section), "; "))));
  }
}
}  // namespace

void write_html(std::ostream& out, const Summary& summary) {
  begin_page(out, summary.title);
  if (const std::string warning = banner(summary); !warning.empty()) {
    core::print(out, "<p class=simulated>{}</p>\n", escaped(warning));
  }
  for (const auto& block : summary.blocks) {
    block->write_words_html(out, summary.participants);
  }
  for (const ReportSection& section : summary.sections) {
    write_findings_html(out, section);
  }
  if (summary.participants > 0) {
    core::print(out, "<p class=note>{} {}</p>\n", people_in_words(summary),
                escaped(tests_in_words(summary)));
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
  write_body(out, summary);
  write_references(out, references_of(summary));
  if (!summary.notes.empty()) {
    core::print(out, "<h2>Notes of the protocol</h2><p class=notes>{}</p>\n",
                escaped(summary.notes));
  }
  end_page(out, summary.provenance);
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
  json["methods"] = methods(summary).words;
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
                  const std::vector<ReportSection>& sections) {
  for (const ReportSection& section : sections) {
    for (const ReportTable* const table : tables_shown(section, &ShownIn::latex)) {
      out << '\n';
      write_table_latex(out, *table, label_of(block, table->name));
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
    write_tables(out, block->block, block->sections);
  }
  write_tables(out, "", summary.sections);
  for (const std::string& reference : references_of(summary)) {
    core::print(out, "% {}\n", latex_text(reference));
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
    std::vector<Chart> charts;
    for (const ReportSection& section : block->sections) {
      charts.insert(charts.end(), section.charts.begin(), section.charts.end());
    }
    add(block->block, charts);
  }
  for (const ReportSection& section : summary.sections) {
    add(section.name, section.charts);
    add(section.name, section.folded_charts);
  }
  return files;
}

namespace {
std::string csv_text(const Summary& summary, const ReportTable& table) {
  std::ostringstream text;
  if (!banner(summary).empty()) {
    text << mode_mark << words_of_modes(summary) << '\n';
  }
  write_table_csv(text, table);
  return text.str();
}
}  // namespace

// A block may have a name that makes its tables those of a section, or of another block.
std::vector<TableFile> table_files(const Summary& summary) {
  std::vector<TableFile> files;
  std::set<std::string> taken;
  for (const ReportTable* const table : csv_tables(summary.sections)) {
    taken.insert(table->name + ".csv");
  }
  for (const auto& block : summary.blocks) {
    for (const ReportTable* const table : csv_tables(block->sections)) {
      std::string name = (block->block.empty() ? "" : block->block + "_") + table->name + ".csv";
      while (!taken.insert(name).second) {
        name = "block_" + name;
      }
      files.push_back({name, csv_text(summary, *table)});
    }
  }
  for (const ReportTable* const table : csv_tables(summary.sections)) {
    files.push_back({table->name + ".csv", csv_text(summary, *table)});
  }
  return files;
}
}  // namespace tapstudy::analysis
