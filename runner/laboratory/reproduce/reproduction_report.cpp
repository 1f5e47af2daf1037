#include "runner/laboratory/reproduce/reproduction_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <vector>

#include "analysis/report/document/formats.hpp"
#include "analysis/report/figures/image_formats.hpp"
#include "analysis/report/html_style.hpp"
#include "core/error.hpp"
#include "core/files/output_files.hpp"
#include "core/text/print.hpp"
#include "runner/laboratory/reproduce/claims.hpp"
namespace tapstudy::runner {
// After that of reports (analysis/report/html_style.hpp), of which this changes some colours for
// those who read on a dark screen.
inline constexpr const char* reproduction_style = R"css(
:root{color-scheme:light dark}
.verdict{display:inline-block;min-width:4.5rem;text-align:center;border-radius:.3rem;padding:0 .5rem;color:#fff;font-weight:600}
.true{background:#1b6e3c}.false{background:#a32a2a}.depends{background:#7a5600}
.claim{border-top:1px solid #cdd6df;margin-top:1.5rem;padding-top:.5rem}.claim h3{margin:.3rem 0;border:0}
.claim h4{font-size:1rem;margin:1rem 0 .3rem}code{font:.85rem ui-monospace,monospace;overflow-wrap:anywhere}
.scroll{margin:.3rem 0 1rem}.data th,.data td,.data thead th{white-space:normal;text-align:left;vertical-align:top}
.data .missed{color:#a32a2a}.overview th[scope=row]{min-width:11rem}
.small{grid-template-columns:repeat(auto-fill,minmax(min(100%,17rem),1fr))}
.force .line{stroke:#1b2733;stroke-width:1.2}.force .alone{stroke:#08519c;stroke-width:1.2}
.map{width:100%;height:auto}.map text{font-size:11px;fill:currentColor}
details{margin:.5rem 0}.animation img{max-width:100%;image-rendering:pixelated}summary{cursor:pointer;color:#08519c}
a{color:#08519c}
@media (max-width:600px){body{margin:1rem auto}}
@media (prefers-color-scheme:dark){
body{background:#12181f;color:#dbe3ea}.simulated{background:#3a3010;border-color:#d39e00}
.note,.provenance,caption,figcaption{color:#9fb0bf}a,summary,.contents a{color:#8cc0f5}
.claim,section>h3{border-color:#3a4753}.data .missed{color:#f29a9a}
.chart .frame{stroke:#7b8b9a}.chart .line{stroke:#b9c7d4}.chart .chance{stroke:#e08a87}
.chart circle{fill:#8cc0f5;stroke:#8cc0f5}.chart circle.open{fill:#12181f}.force .line{stroke:#dbe3ea}.force .alone{stroke:#8cc0f5}
}
)css";

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
              escaped(measure.name), escaped(describe_value(measure)),
              measure.holds() ? "" : " class=missed",
              measure.is_judged() ? fmt::format("{}: {}", escaped(describe_limits(measure)),
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
                escaped(describe_value(finding)));
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

namespace {
using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json as_json(const Measure& measure) {
  Json json{{"name", measure.name}, {"value", number(measure.value)}, {"unit", measure.unit}};
  json["at_least"] = number(measure.at_least.value_or(std::nan("")));
  json["at_most"] = number(measure.at_most.value_or(std::nan("")));
  json["holds"] = measure.holds();
  return json;
}

Json as_json(const std::vector<Measure>& measures) {
  Json all = Json::array();
  for (const Measure& measure : measures) {
    all.push_back(as_json(measure));
  }
  return all;
}

Json as_json(const Claim& claim, const std::string& group) {
  Json json{{"name", claim.name},
            {"group", group},
            {"section", claim.section},
            {"statement", claim.statement}};
  json["verdict"] = name(claim.verdict());
  json["reasons"] = claim.reasons();
  json["rule"] = claim.rule;
  json["methods"] = Json::array();
  for (const Method& method : claim.methods) {
    json["methods"].push_back({{"name", method.name},
                               {"command", method.command},
                               {"confirms", method.confirms()},
                               {"measures", as_json(method.measures)}});
  }
  json["findings"] = as_json(claim.findings);
  json["remarks"] = claim.remarks;
  return json;
}
}  // namespace

void write_json(std::ostream& out, const Reproduction& reproduction) {
  Json json{{"schema_version", 1},
            {"paper", paper_title},
            {"program", reproduction.program},
            {"command", command_of(reproduction)},
            {"machine", reproduction.machine},
            {"seed", reproduction.seed},
            {"is_quick", reproduction.effort == Effort::quick},
            {"judging_rule", judging_rule}};
  json["claims"] = Json::array();
  for (const MeasuredGroup& group : reproduction.groups) {
    for (const Claim& claim : group.claims) {
      json["claims"].push_back(as_json(claim, group.title));
    }
  }
  json["not_reproducible"] = Json::array();
  for (const NotReproducible& one : reproduction.not_reproducible) {
    json["not_reproducible"].push_back(
        {{"section", one.section}, {"statement", one.statement}, {"why", one.why}});
  }
  out << json.dump(2) << '\n';
}

namespace {
constexpr const char* page_file = "reproduction.html";
constexpr const char* json_file = "reproduction.json";

std::string in(const std::string& directory, std::string_view name) {
  return (std::filesystem::path{directory} / name).string();
}

std::string written(void (*write)(std::ostream&, const Reproduction&),
                    const Reproduction& reproduction) {
  std::ostringstream text;
  write(text, reproduction);
  return text.str();
}
}  // namespace

void create_reproduction_directory(const std::string& directory) {
  core::make_directories(directory);
  core::check_is_new(in(directory, page_file));
  core::check_is_new(in(directory, json_file));
  core::check_is_new(in(directory, strike_animation_file));
}

void write_files(const std::string& directory, const Reproduction& reproduction) {
  std::vector<core::NewFile> files{{in(directory, page_file), written(write_html, reproduction)},
                                   {in(directory, json_file), written(write_json, reproduction)}};
  for (const MeasuredGroup& group : reproduction.groups) {
    for (const Claim& claim : group.claims) {
      for (const Animation& animation : claim.animations) {
        files.push_back({in(directory, animation.file), animation.png});
      }
    }
  }
  core::write_all_or_none(files, core::Existing::kept);
}

std::string command_of(const Reproduction& reproduction) {
  std::string only;
  for (const std::string& name : reproduction.only) {
    only += " --only " + name;
  }
  return fmt::format("tapstudy reproduce{}{} --seed {} --out DIR", only,
                     reproduction.effort == Effort::quick ? " --quick" : "", reproduction.seed);
}

void print(const Reproduction& reproduction) {
  for (const MeasuredGroup& group : reproduction.groups) {
    fmt::print("{}\n", group.title);
    for (const Claim& claim : group.claims) {
      fmt::print("  {:<8} {}\n", name(claim.verdict()), claim.statement);
    }
  }
}
}  // namespace tapstudy::runner
