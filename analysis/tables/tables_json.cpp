#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/blocks/json_parts.hpp"
#include "analysis/tables/table_writers.hpp"
#include "analysis/tables/tabular_summary.hpp"
namespace tapstudy::analysis {
namespace {
using Json = nlohmann::ordered_json;

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

nlohmann::ordered_json TabularSummary::as_json() const {
  Json json{{"block", block}, {"task", task}};
  for (const ReportTable& table : parts) {
    json[table.name] = table_json(table);
  }
  json["remarks"] = remarks;
  json["hypotheses"] = analysis::as_json(hypotheses);
  return json;
}
}  // namespace tapstudy::analysis
