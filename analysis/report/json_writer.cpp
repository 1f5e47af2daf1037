#include <nlohmann/json.hpp>

#include "analysis/report/references.hpp"
#include "analysis/report/writers.hpp"
namespace tapstudy::analysis {
using Json = nlohmann::ordered_json;

void write_json(std::ostream& out, const Summary& summary) {
  Json json{{"schema_version", 1},
            {"title", summary.title},
            {"modes", summary.modes},
            {"participants", summary.participants}};
  json["unfinished"] = summary.unfinished;
  json["excluded"] = summary.excluded;
  json["deviations"] = summary.deviations;
  json["blocks"] = Json::array();
  for (const auto& block : summary.blocks) {
    json["blocks"].push_back(block->as_json());
  }
  if (!summary.sections.empty()) {
    json["study"] = Json::object();
    add_sections(json["study"], summary.sections);
  }
  if (summary.loop) {
    json["loop"] = {
        {"ticks", summary.loop->ticks},     {"late", summary.loop->late},
        {"skipped", summary.loop->skipped}, {"dropped_samples", summary.loop->dropped_samples},
        {"impacts", summary.loop->impacts}, {"late_impacts", summary.loop->late_impacts}};
  }
  json["provenance"] = Json::object();
  for (const auto& [key, value] : summary.provenance) {
    json["provenance"][key] = value;
  }
  json["methods"] = methods(summary);
  json["references"] = references_in(json.dump(-1, ' ', false));
  out << json.dump(2) << '\n';
}
}  // namespace tapstudy::analysis
