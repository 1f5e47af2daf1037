#include <nlohmann/json.hpp>

#include "analysis/blocks/json_parts.hpp"
#include "analysis/identification/identification_summary.hpp"
namespace tapstudy::analysis {
namespace {
using Json = nlohmann::ordered_json;

Json names_of(const std::vector<Item>& items) {
  Json names = Json::array();
  for (const Item& item : items) {
    names.push_back(item.name);
  }
  return names;
}

// The interval is that over participants, null where there are not two.
Json share_json(const Proportion& pooled, const std::optional<MeanProportion>& over) {
  Json json = as_json(pooled);
  json["over_participants_95"] =
      over ? Json{over->interval.low, over->interval.high} : Json(nullptr);
  return json;
}
}  // namespace

nlohmann::ordered_json IdentificationSummary::as_json() const {
  Json json{{"block", block},
            {"task", task},
            {"stimuli", names_of(matrix.stimuli)},
            {"responses", names_of(matrix.responses)},
            {"counts", matrix.counts},
            {"chance", matrix.chance()},
            {"accuracy", share_json(accuracy, accuracy_over_participants)}};
  json["factors"] = Json::array();
  for (const FactorResult& result : factors) {
    Json factor{{"factor", result.factor}};
    factor["given"] = result.given.empty() ? Json(nullptr) : Json(result.given);
    factor["accuracy"] = share_json(result.accuracy, result.over_participants);
    factor["chance"] = result.chance;
    factor["p"] = result.p ? Json(*result.p) : Json(nullptr);
    json["factors"].push_back(factor);
  }
  json["participants"] = Json::array();
  for (const ParticipantAccuracy& participant : participants) {
    json["participants"].push_back({{"participant_id", participant.participant_id},
                                    {"accuracy", analysis::as_json(participant.accuracy)}});
  }
  add_sections(json, sections);
  json["hypotheses"] = analysis::as_json(hypotheses);
  return json;
}
}  // namespace tapstudy::analysis
