#include <nlohmann/json.hpp>

#include "analysis/report/writers.hpp"
namespace tapstudy::analysis {
namespace {
using Json = nlohmann::ordered_json;

Json as_json(const Proportion& proportion) {
  Json json{{"successes", proportion.successes}, {"trials", proportion.trials}};
  if (proportion.trials == 0) {
    json["value"] = nullptr;
    json["wilson_95"] = nullptr;
    return json;
  }
  const Interval interval = wilson_interval(proportion);
  json["value"] = proportion.value();
  json["wilson_95"] = {interval.low, interval.high};
  return json;
}

Json as_json(const std::vector<HypothesisResult>& hypotheses) {
  Json list = Json::array();
  for (const HypothesisResult& result : hypotheses) {
    list.push_back({{"name", result.planned.name},
                    {"statement", result.planned.statement},
                    {"test", result.test},
                    {"observed", as_json(result.observed)},
                    {"chance", result.chance},
                    {"p", result.p}});
  }
  return list;
}

Json names_of(const std::vector<Item>& items) {
  Json names = Json::array();
  for (const Item& item : items) {
    names.push_back(item.name);
  }
  return names;
}

Json as_json(const IdentificationSummary& summary) {
  Json json{{"block", summary.block},
            {"task", "identification"},
            {"stimuli", names_of(summary.matrix.stimuli)},
            {"responses", names_of(summary.matrix.responses)},
            {"counts", summary.matrix.counts},
            {"chance", summary.matrix.chance()},
            {"accuracy", as_json(summary.accuracy)}};
  json["factors"] = Json::array();
  for (const FactorResult& result : summary.factors) {
    Json factor{{"factor", result.factor}};
    factor["given"] = result.given.empty() ? Json{nullptr} : Json(result.given);
    factor["accuracy"] = as_json(result.accuracy);
    factor["chance"] = result.chance;
    json["factors"].push_back(factor);
  }
  json["participants"] = Json::array();
  for (const ParticipantAccuracy& participant : summary.participants) {
    json["participants"].push_back({{"participant_id", participant.participant_id},
                                    {"accuracy", as_json(participant.accuracy)}});
  }
  json["hypotheses"] = as_json(summary.hypotheses);
  return json;
}

Json as_json(const ChoiceSummary& summary) {
  Json json{{"block", summary.block}, {"task", "choice"}};
  json["alternatives"] = Json::array();
  for (const AlternativeResult& result : summary.alternatives) {
    json["alternatives"].push_back({{"stimulus", result.item.name},
                                    {"chosen", as_json(result.chosen)},
                                    {"visits", result.visits},
                                    {"dwell_s", result.dwell_s}});
  }
  json["choices"] = Json::array();
  for (const auto& [participant, stimulus] : summary.choices) {
    json["choices"].push_back({{"participant_id", participant}, {"stimulus", stimulus}});
  }
  json["exact_multinomial_p"] =
      summary.multinomial_p ? Json(*summary.multinomial_p) : Json(nullptr);
  json["has_repeated_choices"] = summary.has_repeated_choices;
  json["hypotheses"] = as_json(summary.hypotheses);
  return json;
}
}  // namespace

void write_json(std::ostream& out, const Summary& summary) {
  Json json{{"schema_version", 1},
            {"title", summary.title},
            {"modes", summary.modes},
            {"participants", summary.participants}};
  json["blocks"] = Json::array();
  for (const BlockSummary& block : summary.blocks) {
    json["blocks"].push_back(std::visit([](const auto& one) { return as_json(one); }, block));
  }
  if (summary.loop) {
    json["loop"] = {{"ticks", summary.loop->ticks},
                    {"late", summary.loop->late},
                    {"skipped", summary.loop->skipped},
                    {"dropped_samples", summary.loop->dropped_samples}};
  }
  json["provenance"] = Json::object();
  for (const auto& [key, value] : summary.provenance) {
    json["provenance"][key] = value;
  }
  out << json.dump(2) << '\n';
}
}  // namespace tapstudy::analysis
