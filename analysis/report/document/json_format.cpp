#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/report/document/formats.hpp"
#include "analysis/report/document/sections.hpp"
#include "analysis/report/document/wording.hpp"
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
                    {"chance", result.finding.empty() ? Json(result.chance) : Json(nullptr)},
                    {"finding", result.finding},
                    {"p", result.p ? Json(*result.p) : Json(nullptr)},
                    {"p_is_upper_bound", result.p_floor > 0.0},
                    {"p_holm", result.p_holm ? Json(*result.p_holm) : Json(nullptr)}});
  }
  return list;
}

namespace {
// JSON has no infinite numbers.
struct ToJson {
  Json operator()(std::monostate) const { return nullptr; }
  Json operator()(double value) const {
    if (std::isinf(value)) {
      return value > 0.0 ? "inf" : "-inf";
    }
    return std::isnan(value) ? Json(nullptr) : Json(value);
  }
  template <class Other>
  Json operator()(const Other& value) const {
    return value;
  }
};

Json row_json(const ReportTable& table, const std::vector<Cell>& row) {
  Json json = Json::object();
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::vector<std::string>& keys = table.columns[i].keys;
    for (std::size_t k = 0; k < keys.size(); ++k) {
      json[keys[k]] = std::visit(ToJson{}, row[i].values.at(k));
    }
  }
  return json;
}
}  // namespace

nlohmann::ordered_json table_json(const ReportTable& table) {
  Json rows = Json::array();
  for (const auto& row : table.rows) {
    rows.push_back(row_json(table, row));
  }
  return rows;
}

namespace {
Json main_results_json(const BlockSummary& block) {
  const ToJson value;
  const int answered = block.number_who_answered();
  Json list = Json::array();
  for (const MainResult& result : block.main_results) {
    list.push_back({{"name", result.name},
                    {"estimate", value(result.estimate)},
                    {"low", result.range ? value(result.range->low) : Json(nullptr)},
                    {"high", result.range ? value(result.range->high) : Json(nullptr)},
                    {"participants", result.people ? Json(*result.people) : Json(nullptr)},
                    {"in_words", in_words(result, answered)}});
  }
  return list;
}
}  // namespace

nlohmann::ordered_json BlockSummary::as_json() const {
  Json json{{"block", block}, {"task", task}, {"main_results", main_results_json(*this)}};
  if (values) {
    json.update(*values);
  }
  add_sections(json, sections);
  json["hypotheses"] = analysis::as_json(hypotheses);
  return json;
}
}  // namespace tapstudy::analysis
