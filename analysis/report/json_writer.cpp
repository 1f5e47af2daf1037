#include <nlohmann/json.hpp>

#include "analysis/report/writers.hpp"
namespace tapstudy::analysis {
using Json = nlohmann::ordered_json;
namespace {
// A file's name need not be UTF-8.
std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}
}  // namespace

void write_json(std::ostream& out, const Summary& summary) {
  Json json{{"schema_version", 1},
            {"title", summary.title},
            {"modes", words_of_modes(summary)},
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
  json["references"] = references_of(summary);
  out << text_of(json, 2) << '\n';
}
}  // namespace tapstudy::analysis
