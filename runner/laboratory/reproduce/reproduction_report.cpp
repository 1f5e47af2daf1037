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
#include "core/error.hpp"
#include "core/files/data_url.hpp"
#include "core/files/output_files.hpp"
#include "core/text/print.hpp"
#include "runner/laboratory/reproduce/claims.hpp"
namespace tapstudy::runner {
// After that of reports.
inline constexpr const char* reproduction_style = R"css(
.verdict{display:inline-block;min-width:4.5rem;text-align:center;border-radius:.3rem;padding:0 .5rem;color:#fff;font-weight:600}
.true{background:#1b6e3c}.false{background:#a32a2a}.depends{background:#7a5600}.shown{background:#4a5763}
.claim{border-top:1px solid #cdd6df;margin-top:1.5rem;padding-top:.5rem}.claim h3{margin:.3rem 0;border:0}
.claim h4{font-size:1rem;margin:1rem 0 .3rem}code{font:.85rem ui-monospace,monospace;overflow-wrap:anywhere}
.scroll{margin:.3rem 0 1rem}.data th,.data td,.data thead th{white-space:normal;text-align:left;vertical-align:top}
.data .missed{color:#a32a2a}.overview th[scope=row]{min-width:11rem}
.small{grid-template-columns:repeat(auto-fill,minmax(min(100%,17rem),1fr))}
.force .line{stroke:#1b2733;stroke-width:1.2}.force .alone{stroke:#08519c;stroke-width:1.2}
.map{width:100%;height:auto}.map text{font-size:11px;fill:currentColor}
details{margin:.5rem 0}.animation img{max-width:100%;image-rendering:pixelated}summary{cursor:pointer;color:#08519c}
a{color:#08519c}
@media screen and (prefers-color-scheme:dark){a,summary{color:#8ab8e6}.claim{border-color:#3a4754}
  .data .missed{color:#f29a9a}.force .line{stroke:#dde5ec}.force .alone{stroke:#8ab8e6}}
)css";

namespace {
using analysis::escaped;
using analysis::ReportTable;
using analysis::Value;

std::string verdict(const Claim& claim) {
  return fmt::format("<span class=\"verdict {0}\">{0}</span>", name(claim.verdict()));
}

// Programs read null where there is no number.
Value finite(std::optional<double> number) {
  return number && std::isfinite(*number) ? Value{*number} : Value{};
}

ReportTable table_of(const std::string& title, const std::vector<Measure>& measures) {
  ReportTable table{"measures",
                    title,
                    {analysis::column("measure", "name"),
                     {"value", {"value", "unit"}},
                     {"must be", {"at_least", "at_most", "holds"}}}};
  for (const Measure& measure : measures) {
    const bool holds = measure.holds();
    analysis::Cell limits{"", {finite(measure.at_least), finite(measure.at_most), holds}};
    if (measure.is_judged()) {
      limits.text =
          fmt::format("{}: {}", describe_limits(measure), holds ? "holds" : "does not hold");
      limits.style = holds ? "" : "missed";
    }
    table.rows.push_back({analysis::word(measure.name),
                          {describe_value(measure), {finite(measure.value), measure.unit}},
                          limits});
  }
  return table;
}

void write_numbers(std::ostream& out, const Claim& claim) {
  for (const Method& method : claim.methods) {
    core::print(out, "<h4>{}: {}</h4>\n<p><code>{}</code></p>\n", escaped(method.name),
                !method.judges()    ? "shown"
                : method.confirms() ? "holds"
                                    : "does not hold",
                escaped(method.command));
    write_framed_html(out, table_of(method.name, method.measures));
  }
  if (!claim.findings.empty()) {
    out << "<h4>Beside the judgement</h4>\n";
    write_framed_html(out, table_of("Beside the judgement of " + claim.name, claim.findings));
  }
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
  write_numbers(out, claim);
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
                core::data_url("image/png", animation.png), escaped(animation.title),
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

ReportTable overview_of(const Reproduction& reproduction) {
  ReportTable table{
      "claims",
      "All claims",
      {analysis::column("claim", "statement"), analysis::column("judgement", "verdict"),
       analysis::column("if it depends, it holds", "confirming"),
       analysis::column("the paper", "section")}};
  for (const MeasuredGroup& group : reproduction.groups) {
    for (const Claim& claim : group.claims) {
      const std::string judged{name(claim.verdict())};
      table.rows.push_back({analysis::word(claim.statement), analysis::word(judged),
                            analysis::word(confirming(claim)), analysis::word(claim.section)});
      table.rows.back()[0].anchor = claim.name;
      table.rows.back()[1].style = "verdict " + judged;
    }
  }
  return table;
}

ReportTable table_of(const std::vector<NotReproducible>& statements) {
  ReportTable table{"not_reproducible",
                    "What no computation can show",
                    {analysis::column("the paper says", "statement"),
                     analysis::column("section", "section"), analysis::column("why", "why")}};
  for (const NotReproducible& one : statements) {
    table.rows.push_back(
        {analysis::word(one.statement), analysis::word(one.section), analysis::word(one.why)});
  }
  return table;
}
}  // namespace

void write_html(std::ostream& out, const Reproduction& reproduction) {
  analysis::begin_page(out, page_title, reproduction_style);
  core::print(out, "<p>{}</p>\n<p>{}</p>\n<p class=simulated>{}</p>\n<div class=overview>",
              escaped(introduction), escaped(judging_rule), escaped(simulated_note));
  write_framed_html(out, overview_of(reproduction));
  out << "</div>\n";
  for (const MeasuredGroup& group : reproduction.groups) {
    core::print(out, "<h2>{}</h2>\n", escaped(group.title));
    for (const Claim& claim : group.claims) {
      write_claim(out, claim);
    }
  }
  out << "<h2 id=\"not-reproducible\">What no computation can show</h2>\n";
  write_framed_html(out, table_of(reproduction.not_reproducible));
  analysis::end_page(out, {{"program", reproduction.program},
                           {"command", command_of(reproduction)},
                           {"times measured on", reproduction.machine}});
}

namespace {
using Json = nlohmann::ordered_json;

Json as_json(const Claim& claim, const std::string& group) {
  Json json{{"name", claim.name},
            {"group", group},
            {"section", claim.section},
            {"statement", claim.statement}};
  json["verdict"] = name(claim.verdict());
  json["reasons"] = claim.reasons();
  json["rule"] = claim.rule;
  json["unknown_input"] = claim.unknown_input;
  json["methods"] = Json::array();
  for (const Method& method : claim.methods) {
    json["methods"].push_back({{"name", method.name},
                               {"command", method.command},
                               {"judges", method.judges()},
                               {"confirms", method.confirms()},
                               {"measures", table_json(table_of("", method.measures))}});
  }
  json["findings"] = table_json(table_of("", claim.findings));
  json["remarks"] = claim.remarks;
  return json;
}
}  // namespace

void write_json(std::ostream& out, const Reproduction& reproduction) {
  Json json{{"schema_version", 2},
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
  json["not_reproducible"] = table_json(table_of(reproduction.not_reproducible));
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
