#include <nlohmann/json.hpp>

#include "analysis/blocks/json_parts.hpp"
#include "analysis/choice/choice_summary.hpp"
namespace tapstudy::analysis {
using Json = nlohmann::ordered_json;

nlohmann::ordered_json ChoiceSummary::as_json() const {
  Json json{{"block", block}, {"task", task}};
  json["alternatives"] = Json::array();
  for (const AlternativeResult& result : alternatives) {
    json["alternatives"].push_back(
        {{"stimulus", result.item.name},
         {"chosen", analysis::as_json(result.chosen)},
         {"goodman_95",
          result.interval ? Json{result.interval->low, result.interval->high} : Json(nullptr)},
         {"sison_glaz_95", result.sison_glaz ? Json{result.sison_glaz->low, result.sison_glaz->high}
                                             : Json(nullptr)},
         {"visits", result.visits},
         {"dwell_s", result.dwell_s}});
  }
  json["choices"] = Json::array();
  for (const auto& [participant, stimulus] : choices) {
    json["choices"].push_back({{"participant_id", participant}, {"stimulus", stimulus}});
  }
  json["exact_multinomial_p"] = multinomial_p ? Json(*multinomial_p) : Json(nullptr);
  json["has_repeated_choices"] = has_repeated_choices;
  json["hypotheses"] = analysis::as_json(hypotheses);
  add_sections(json, sections);
  return json;
}
}  // namespace tapstudy::analysis
