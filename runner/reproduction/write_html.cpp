#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/blocks/html_parts.hpp"
#include "analysis/figures/svg_formats.hpp"
#include "analysis/report/html_style.hpp"
#include "core/print.hpp"
#include "runner/reproduction/page_style.hpp"
#include "runner/reproduction/writers.hpp"
namespace tapstudy::runner {
namespace {
using analysis::escaped;

std::string verdict(const Claim& claim) {
  return fmt::format("<span class=\"verdict {0}\">{0}</span>", name(claim.verdict()));
}

void begin_table(std::ostream& out, const std::string& label, const std::string& headings) {
  core::print(out,
              "<div class=scroll tabindex=0 role=region aria-label=\"{}\"><table class=data><thead>"
              "<tr>{}</tr></thead><tbody>\n",
              escaped(label), headings);
}
constexpr const char* end_table = "</tbody></table></div>\n";

void write_measure(std::ostream& out, const Measure& measure) {
  core::print(out, "<tr><th scope=row>{}</th><td>{}</td><td{}>{}</td></tr>\n",
              escaped(measure.name), escaped(value_in_words(measure)),
              measure.holds() ? "" : " class=missed",
              measure.is_judged() ? fmt::format("{}: {}", escaped(limits_in_words(measure)),
                                                measure.holds() ? "holds" : "does not hold")
                                  : "");
}

void write_method(std::ostream& out, const Method& method) {
  core::print(out, "<h4>{}: {}</h4>\n<p><code>{}</code></p>\n", escaped(method.name),
              method.confirms() ? "holds" : "does not hold", escaped(method.command));
  begin_table(out, method.name,
              "<th scope=col>measure</th><th scope=col>value</th><th scope=col>must be</th>");
  for (const Measure& measure : method.measures) {
    write_measure(out, measure);
  }
  out << end_table;
}

void write_findings(std::ostream& out, const Claim& claim) {
  if (claim.findings.empty()) {
    return;
  }
  out << "<h4>Beside the judgement</h4>\n";
  begin_table(out, "Beside the judgement of " + claim.name,
              "<th scope=col>what</th><th scope=col>value</th>");
  for (const Measure& finding : claim.findings) {
    core::print(out, "<tr><th scope=row>{}</th><td>{}</td></tr>\n", escaped(finding.name),
                escaped(value_in_words(finding)));
  }
  out << end_table;
}

void write_claim(std::ostream& out, const Claim& claim) {
  core::print(out, "<section class=claim id=\"{}\"><h3>{} {}</h3>\n<p>The paper, {}.</p>\n<ul>\n",
              escaped(claim.name), verdict(claim), escaped(claim.statement),
              escaped(claim.section));
  for (const std::string& reason : claim.reasons()) {
    core::print(out, "<li>{}</li>\n", escaped(reason));
  }
  core::print(out, "</ul>\n<p class=note>Judged: {}</p>\n", escaped(claim.rule));
  for (const std::string& remark : claim.remarks) {
    core::print(out, "<p>{}</p>\n", escaped(remark));
  }
  out << "<details><summary>Numbers and commands</summary>\n";
  for (const Method& method : claim.methods) {
    write_method(out, method);
  }
  write_findings(out, claim);
  out << "</details>\n";
  for (const Drawing& drawing : claim.drawings) {
    core::print(out, "<details{}><summary>{}</summary>\n<div class=\"charts small\">\n",
                drawing.is_open ? " open" : "", escaped(drawing.title));
    for (const std::string& svg : drawing.svg) {
      out << svg;
    }
    out << "</div></details>\n";
  }
  for (const Animation& animation : claim.animations) {
    core::print(out,
                "<figure class=animation><img src=\"{}\" alt=\"{}\"><figcaption>{} ({})"
                "</figcaption></figure>\n",
                analysis::png_data_uri(animation.png), escaped(animation.title),
                escaped(animation.title), escaped(animation.file));
  }
  out << "</section>\n";
}

// The methods of which it depends.
std::string confirming(const Claim& claim) {
  std::vector<std::string> names;
  for (const Method& method : claim.methods) {
    if (method.confirms()) {
      names.push_back(method.name);
    }
  }
  return claim.verdict() == ClaimVerdict::depends ? fmt::format("{}", fmt::join(names, "; ")) : "";
}

void write_overview(std::ostream& out, const Reproduction& reproduction) {
  out << "<div class=overview>";
  begin_table(out, "All claims",
              "<th scope=col>claim</th><th scope=col>judgement</th><th scope=col>if it depends, it "
              "holds</th><th scope=col>the paper</th>");
  for (const MeasuredGroup& group : reproduction.groups) {
    for (const Claim& claim : group.claims) {
      core::print(out,
                  "<tr><th scope=row><a href=\"#{}\">{}</a></th><td>{}</td><td>{}</td><td>{}</td>"
                  "</tr>\n",
                  escaped(claim.name), escaped(claim.statement), verdict(claim),
                  escaped(confirming(claim)), escaped(claim.section));
    }
  }
  out << end_table << "</div>\n";
}

void write_not_reproducible(std::ostream& out, const Reproduction& reproduction) {
  out << "<h2 id=\"not-reproducible\">What no computation can show</h2>\n";
  begin_table(out, "What no computation can show",
              "<th scope=col>the paper says</th><th scope=col>section</th><th scope=col>why</th>");
  for (const NotReproducible& one : reproduction.not_reproducible) {
    core::print(out, "<tr><th scope=row>{}</th><td>{}</td><td>{}</td></tr>\n",
                escaped(one.statement), escaped(one.section), escaped(one.why));
  }
  out << end_table;
}
}  // namespace

void write_html(std::ostream& out, const Reproduction& reproduction) {
  core::print(
      out,
      "<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><meta name=viewport "
      "content=\"width=device-width\"><title>{0}</title><style>{1}{2}</style></head><body>\n"
      "<h1>{0}</h1>\n<p>{3}</p>\n<p>{4}</p>\n",
      escaped(page_title), analysis::html_style, reproduction_style, escaped(introduction),
      escaped(judging_rule));
  core::print(out, "<p class=simulated>{}</p>\n", escaped(simulated_note));
  write_overview(out, reproduction);
  for (const MeasuredGroup& group : reproduction.groups) {
    core::print(out, "<h2>{}</h2>\n", escaped(group.title));
    for (const Claim& claim : group.claims) {
      write_claim(out, claim);
    }
  }
  write_not_reproducible(out, reproduction);
  core::print(
      out,
      "<h2>Provenance</h2><table class=provenance>\n<tr><th scope=row>program</th><td>{}</td>"
      "</tr>\n<tr><th scope=row>command</th><td><code>{}</code></td></tr>\n<tr><th "
      "scope=row>times measured on</th><td>{}</td></tr>\n</table>\n</body></html>\n",
      escaped(reproduction.program), escaped(command_of(reproduction)),
      escaped(reproduction.machine));
}
}  // namespace tapstudy::runner
