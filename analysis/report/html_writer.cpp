#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>

#include "analysis/blocks/html_parts.hpp"
#include "analysis/report/html_style.hpp"
#include "analysis/report/references.hpp"
#include "analysis/report/writers.hpp"
#include "analysis/tables/sections.hpp"
#include "core/print.hpp"
namespace tapstudy::analysis {
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
}  // namespace tapstudy::analysis
