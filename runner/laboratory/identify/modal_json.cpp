#include <nlohmann/json.hpp>

#include "runner/laboratory/identify/modal_report.hpp"
#include "runner/laboratory/identify/responses/response_identification.hpp"
namespace tapstudy::runner {
namespace {
using Json = nlohmann::ordered_json;

Json json_of(double number) {
  return number;
}

Json json_of(const analysis::Interval& interval) {
  return Json{interval.low, interval.high};
}

Json json_of(const analysis::Estimate& estimate) {
  Json json{{"value", estimate.value},
            {"standard_error", estimate.standard_error},
            {"interval_95", json_of(estimate.interval)}};
  if (estimate.bootstrap) {
    json["bootstrap_95"] = json_of(*estimate.bootstrap);
  }
  return json;
}

Json json_of(const analysis::Pole& pole) {
  return {{"frequency_hz", pole.frequency_hz}, {"damping_ratio", pole.damping_ratio}};
}

Json json_of(const analysis::FittedSinusoid& sinusoid) {
  return {{"amplitude", sinusoid.amplitude},
          {"decay_per_s", sinusoid.decay_per_s},
          {"frequency_hz", sinusoid.frequency_hz},
          {"start_s", sinusoid.start_s},
          {"explained", sinusoid.explained}};
}

Json json_of(const analysis::AmplitudeLine& line) {
  return {{"offset", json_of(line.offset)},
          {"slope", json_of(line.slope)},
          {"is_proportional", line.is_proportional()}};
}

Json json_of(const analysis::AtTap& at_tap);
Json json_of(const analysis::RayleighFit& fit);
Json json_of(const SinusoidLaw& law);
Json json_of(const ModelComparison& model);

// Of one of those above.
template <class Value>
Json json_or_null(const std::optional<Value>& value) {
  return value ? json_of(*value) : Json(nullptr);
}

Json json_of(const analysis::TapMode& mode) {
  const analysis::FittedMode& fitted = mode.fitted;
  return {{"frequency_hz", fitted.pole.frequency_hz},
          {"frequency_error_hz", fitted.frequency_error_hz},
          {"damping_ratio", fitted.pole.damping_ratio},
          {"ratio_error", fitted.ratio_error},
          {"amplitude", fitted.amplitude},
          {"phase_rad", fitted.phase_rad},
          {"standing", name(mode.standing)},
          {"why", mode.why},
          {"stable_orders", mode.stable_orders},
          {"rational_fit", json_or_null(mode.by_rational_fit)}};
}

Json json_of(const IdentifiedTap& tap) {
  Json json{{"recording", tap.file},
            {"channel", tap.channel},
            {"impact", tap.impact},
            {"time_s", tap.time_s},
            {"begin", tap.tap.begin},
            {"end", tap.tap.end},
            {"noise", tap.modes.fit.noise},
            {"explained", tap.modes.fit.explained},
            {"has_converged", tap.modes.fit.has_converged},
            {"significant_order", tap.modes.pencil.significant_order},
            {"modes", Json::array()},
            {"sinusoid", json_or_null(tap.sinusoid)}};
  for (const analysis::TapMode& mode : tap.modes.modes) {
    json["modes"].push_back(json_of(mode));
  }
  if (tap.speed_m_s) {
    json["speed_m_s"] = *tap.speed_m_s;
  }
  if (tap.force) {
    json["impulse_n_s"] = tap.force->impulse_n_s;
  }
  return json;
}

Json json_of(const analysis::AtTap& at_tap) {
  return {{"frequency_hz", at_tap.frequency_hz}, {"damping_ratio", at_tap.damping_ratio}};
}

Json json_of(const analysis::RepeatedMode& mode) {
  return {{"frequency_hz", json_of(mode.frequency_hz)},
          {"damping_ratio", json_of(mode.damping_ratio)},
          {"at_tap", json_or_null(mode.at_tap)},
          {"amplitude", mode.amplitude},
          {"standing", name(mode.standing)},
          {"why", mode.why},
          {"taps", mode.taps},
          {"agreed", mode.agreed}};
}

Json json_of(const analysis::RayleighFit& fit) {
  return {{"alpha_per_s", json_of(fit.alpha_per_s)},
          {"beta_s", json_of(fit.beta_s)},
          {"fitted_ratios", fit.fitted_ratios},
          {"chi_squared", fit.chi_squared},
          {"degrees_of_freedom", fit.degrees_of_freedom},
          {"p", json_or_null(fit.p)},
          {"largest_misfit", fit.largest_misfit},
          {"at_hz", fit.at_hz},
          {"is_bounded", fit.is_bounded},
          {"fits", fit.fits()}};
}

Json json_of(const SinusoidLaw& law) {
  return {{"decay_per_s", json_of(law.decay_per_s)},
          {"frequency_hz", json_of(law.frequency_hz)},
          {"explained", law.explained},
          {"amplitude_per_speed", json_or_null(law.amplitude_per_speed)},
          {"amplitude_line", json_or_null(law.line)},
          {"amplitude_n_s_per_m", json_or_null(law.amplitude_n_s_per_m)}};
}

Json json_of(const ModelComparison& model) {
  Json json{{"material", model.material_name},
            {"frequencies_hz", model.frequencies_hz},
            {"is_orthotropic", model.material->orthotropy.has_value()},
            {"youngs_modulus_pa", nullptr},
            {"matched", Json::array()},
            {"unmatched", Json::array()},
            {"rival_pa", nullptr},
            {"cautions", model.doubts},
            {"spring_factor", nullptr},
            {"mac", nullptr}};
  if (model.assurance.size() > 0) {
    json["mac"] = Json::array();
    for (const auto row : model.assurance.rowwise()) {
      json["mac"].push_back(std::vector<double>(row.begin(), row.end()));
    }
  }
  if (!model.update) {
    return json;
  }
  json["youngs_modulus_pa"] = json_of(model.update->youngs_modulus_pa);
  json["rms_misfit"] = model.update->rms_misfit;
  for (const analysis::MatchedMode& one : model.update->matched) {
    json["matched"].push_back({{"agreed_mode", one.measured},
                               {"model_mode", one.model},
                               {"misfit", one.misfit},
                               {"mac", json_or_null(one.assurance)}});
  }
  json["unmatched"] = model.update->unmatched;
  if (model.springs) {
    json["spring_factor"] = json_of(model.springs->factor);
  }
  json["rival_pa"] = json_or_null(model.update->rival_pa);
  return json;
}
}  // namespace

std::string json_of(const TapIdentification& found) {
  Json json{{"schema_version", 1},
            {"quantity", name(found.question.quantity)},
            {"band_hz", {found.band.low_hz, found.band.high_hz}},
            {"rate_error", found.question.rate_error},
            {"taps", Json::array()},
            {"modes", Json::array()},
            {"others", Json::array()},
            {"others_in_words", found.others},
            {"rayleigh", json_or_null(found.rayleigh)},
            {"sinusoid", json_or_null(found.sinusoid)},
            {"model", json_or_null(found.model)},
            {"remarks", found.remarks}};
  for (const IdentifiedTap& tap : found.taps) {
    json["taps"].push_back(json_of(tap));
  }
  for (const analysis::RepeatedMode& mode : found.modes) {
    json[mode.standing == analysis::Standing::agreed ? "modes" : "others"].push_back(json_of(mode));
  }
  return json.dump(2);
}

namespace {
Json json_of(const analysis::ResponseMode& mode) {
  Json json{{"frequency_hz", json_of(mode.frequency_hz)},
            {"damping_ratio", json_of(mode.damping_ratio)},
            {"standing", name(mode.standing)},
            {"why", mode.why},
            {"orders", mode.orders},
            {"significance", mode.significance},
            {"share", mode.share},
            {"phase_collinearity", mode.phase_collinearity},
            {"shape", Json::array()},
            {"residues", Json::array()}};
  for (const std::complex<double>& at : mode.shape) {
    json["shape"].push_back({at.real(), at.imag()});
  }
  for (const std::complex<double>& residue : mode.residues) {
    json["residues"].push_back({residue.real(), residue.imag()});
  }
  return json;
}
}  // namespace

std::string json_of(const ResponseIdentification& found) {
  const Eigen::ArrayXd& hz = found.responses.measured.frequency_hz;
  Json json{{"schema_version", 1},
            {"kind", name(found.responses.measured.kind)},
            {"band_hz", {hz[0], hz[hz.size() - 1]}},
            {"responses", Json::array()},
            {"places", found.responses.places},
            {"modes", Json::array()},
            {"others", Json::array()},
            {"others_in_words", found.others},
            {"rayleigh", json_or_null(found.rayleigh)},
            {"model", json_or_null(found.model)},
            {"remarks", found.remarks}};
  for (const analysis::ResponsePair& pair : found.responses.measured.pairs) {
    json["responses"].push_back({{"response", pair.response}, {"reference", pair.reference}});
  }
  for (const analysis::ResponseMode& mode : found.responses.modes) {
    json[mode.standing == analysis::Standing::agreed ? "modes" : "others"].push_back(json_of(mode));
  }
  return json.dump(2);
}
}  // namespace tapstudy::runner
