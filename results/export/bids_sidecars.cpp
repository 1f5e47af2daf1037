#include "results/export/bids_sidecars.hpp"

#include <nlohmann/json.hpp>
namespace tapstudy::results {
namespace {
using Json = nlohmann::ordered_json;
constexpr const char* bids_version = "1.8.0";

Json described(const DescribedColumn& known) {
  Json json{{"Description", known.column.description}};
  if (!known.column.unit.empty()) {
    json["Units"] = known.column.unit;
  }
  if (known.column.type == CellType::boolean) {
    json["Levels"] = {{"0", "no"}, {"1", "yes"}};
  }
  for (const auto& [level, meaning] : known.levels) {
    json["Levels"][level] = meaning;
  }
  return json;
}

void add_columns(Json& json, const std::vector<DescribedColumn>& columns) {
  for (const DescribedColumn& known : columns) {
    json[known.column.name] = described(known);
  }
}

std::string text_of(const Json& json) {
  return json.dump(2) + "\n";
}
}  // namespace

std::string dataset_description(const Provenance& provenance) {
  return text_of({{"Name", provenance.title},
                  {"BIDSVersion", bids_version},
                  {"DatasetType", "raw"},
                  {"GeneratedBy", {{{"Name", "tapstudy"}, {"Version", provenance.program}}}}});
}

std::string table_sidecar(const std::vector<DescribedColumn>& columns) {
  Json json = Json::object();
  add_columns(json, columns);
  return text_of(json);
}

std::string phenotype_sidecar(const std::string& tool,
                              const std::vector<DescribedColumn>& columns) {
  Json json{{"MeasurementToolMetadata", {{"Description", tool}}}};
  add_columns(json, columns);
  return text_of(json);
}

std::string task_sidecar(const std::string& task, const BlockText& block,
                         const std::vector<DescribedColumn>& columns) {
  Json json{{"TaskName", task}, {"TaskDescription", block.question}};
  if (!block.instructions.empty()) {
    json["Instructions"] = block.instructions;
  }
  add_columns(json, columns);
  return text_of(json);
}

std::string recording_sidecar(double rate_hz, const std::vector<Column>& columns) {
  Json json{{"SamplingFrequency", rate_hz}, {"StartTime", 0.0}, {"Columns", Json::array()}};
  for (const Column& column : columns) {
    json["Columns"].push_back(column.name);
  }
  for (const Column& column : columns) {
    json[column.name] = described({column});
  }
  return text_of(json);
}
}  // namespace tapstudy::results
