#include <nlohmann/json.hpp>

#include "runner/accuracy/writers.hpp"
namespace tapstudy::runner {
namespace {
// The library writes infinity as null.
nlohmann::ordered_json json_of(const Evaluation& one) {
  return {{"order", one.setting.mesh.order},
          {"max_tet_volume_m3", one.setting.mesh.size.max_tet_volume_m3.value_or(0.0)},
          {"elements", one.tets},
          {"dof", one.dofs},
          {"band_limit_hz", one.setting.band_limit_hz},
          {"modes", one.modes},
          {"integrator", name(one.setting.integrator)},
          {"rate_hz", one.setting.rate_hz},
          {"build_s", one.build_s},
          {"tick_ns", one.tick_ns},
          {"cost_s", one.cost_s},
          {"frequency_error", one.frequency_error},
          {"missing_modes", one.missing_modes},
          {"extra_modes", one.extra_modes},
          {"level_error_db", one.level_error_db},
          {"decay_error_db", one.decay_error_db},
          {"force_error", one.force_error},
          {"is_on_front", one.is_on_front},
          {"is_inside_tolerance", one.is_inside_tolerance},
          {"is_protocols", one.setting.is_protocols}};
}

nlohmann::ordered_json json_of(const Reference& reference) {
  return {{"elements", reference.tets},
          {"dof", reference.dofs},
          {"band_limit_hz", reference.band_limit_hz},
          {"modes", reference.modes},
          {"build_s", reference.build_s},
          {"coarser_elements", reference.coarser_tets},
          {"moved_frequency", reference.moved_frequency},
          {"moved_force", reference.moved_force},
          {"moved_level_db", reference.moved_level_db},
          {"force_beyond", reference.force_beyond}};
}
}  // namespace

std::string json_of(const Trade& trade, const Stability& stability) {
  nlohmann::ordered_json json{{"schema_version", 1}, {"stimulus", trade.stimulus}};
  json["tolerance"] = {{"frequency", trade.tolerance.frequency},
                       {"level_db", trade.tolerance.level_db},
                       {"default_from", "Israr & Tan 2006"}};
  json["reference"] = json_of(trade.reference);
  json["settings"] = nlohmann::ordered_json::array();
  for (const Evaluation& one : trade.settings) {
    json["settings"].push_back(json_of(one));
  }
  json["refused"] = nlohmann::ordered_json::array();
  for (const Refused& one : trade.refused) {
    json["refused"].push_back({{"order", one.mesh.order},
                               {"max_tet_volume_m3", one.mesh.size.max_tet_volume_m3.value_or(0.0)},
                               {"band_limit_hz", one.band_limit_hz},
                               {"is_protocols", one.is_protocols},
                               {"words", one.words}});
  }
  json["cheapest"] = nullptr;
  if (trade.cheapest >= 0) {
    json["cheapest"] = trade.cheapest;
  }
  json["penalty_limit_n_per_m"] = stability.penalty_limit_n_per_m;
  json["stability"] = nlohmann::ordered_json::array();
  for (const StabilityCase& one : stability.cases) {
    json["stability"].push_back({{"property", one.property},
                                 {"value", one.value},
                                 {"outcome", name(one.outcome)},
                                 {"words", one.words}});
  }
  return json.dump(2);
}

}  // namespace tapstudy::runner
