#include <cmath>
#include <nlohmann/json.hpp>

#include "runner/reproduction/writers.hpp"
namespace tapstudy::runner {
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
}  // namespace tapstudy::runner
