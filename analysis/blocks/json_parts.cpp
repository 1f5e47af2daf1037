#include "analysis/blocks/json_parts.hpp"

#include <nlohmann/json.hpp>
namespace tapstudy::analysis {
using Json = nlohmann::ordered_json;

nlohmann::ordered_json as_json(const Proportion& proportion) {
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

nlohmann::ordered_json as_json(const std::vector<HypothesisResult>& hypotheses) {
  Json list = Json::array();
  for (const HypothesisResult& result : hypotheses) {
    list.push_back({{"name", result.planned.name},
                    {"statement", result.planned.statement},
                    {"test", result.test},
                    {"observed", as_json(result.observed)},
                    {"chance", result.chance},
                    {"p", result.p ? Json(*result.p) : Json(nullptr)},
                    {"p_is_upper_bound", result.p_floor > 0.0},
                    {"p_holm", result.p_holm ? Json(*result.p_holm) : Json(nullptr)}});
  }
  return list;
}
}  // namespace tapstudy::analysis
