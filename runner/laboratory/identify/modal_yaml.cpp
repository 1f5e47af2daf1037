#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "runner/laboratory/identify/modal_report.hpp"
namespace tapstudy::runner {
namespace {
std::string numbers(const core::Vec3& v) {
  return fmt::format("[{:.9g}, {:.9g}, {:.9g}]", v.x(), v.y(), v.z());
}

std::string place(const core::Fixation& fixation, bool is_of_box) {
  return is_of_box ? fmt::format("at_m: [{:.9g}, {:.9g}], face: {}", fixation.at_m.x(),
                                 fixation.at_m.y(), name_in(core::face_names, fixation.face))
                   : "at_m: " + numbers(fixation.at_m);
}

std::string where(const core::Fixation& fixation, bool is_of_box) {
  switch (fixation.shape) {
    case core::RegionShape::vertex:
      return place(fixation, is_of_box);
    case core::RegionShape::disc:
      return fmt::format("{}, radius_m: {:.9g}", place(fixation, is_of_box), fixation.radius_m);
    case core::RegionShape::ball:
      return fmt::format("at_m: {}, radius_m: {:.9g}", numbers(fixation.at_m), fixation.radius_m);
    case core::RegionShape::box:
      return fmt::format("low_m: {}, high_m: {}", numbers(fixation.low_m),
                         numbers(fixation.high_m));
    case core::RegionShape::side:
      break;
  }
  return fmt::format("side: {}", name_in(core::side_names, fixation.side));
}

std::string hold(const core::Fixation& fixation) {
  if (const auto& springs = fixation.springs_n_per_m) {
    return fmt::format("springs_n_per_m: [{:.5g}, {:.5g}, {:.5g}]", springs->x(), springs->y(),
                       springs->z());
  }
  std::string axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    axes += fixation.constrained_axes.at(axis) ? std::string(1, "xyz"[axis]) : "";
  }
  return "axes: " + axes;
}
}  // namespace

std::string fixation_yaml(const core::Fixation& fixation, bool is_of_box) {
  return fmt::format("{{region: {}, {}, {}}}", name_in(core::region_names, fixation.shape),
                     where(fixation, is_of_box), hold(fixation));
}

namespace {
using analysis::Estimate;

std::string comment(const Estimate& estimate) {
  return fmt::format("# 95 %: {:.5g} to {:.5g}", estimate.interval.low, estimate.interval.high);
}

struct RatioAt {
  double frequency_hz{};
  double ratio{};
};

double interpolated(const std::vector<RatioAt>& known, double frequency_hz) {
  const auto above = std::ranges::lower_bound(known, frequency_hz, {}, &RatioAt::frequency_hz);
  if (above == known.begin()) {
    return known.front().ratio;
  }
  if (above == known.end()) {
    return known.back().ratio;
  }
  const RatioAt& below = *(above - 1);
  const double share =
      (frequency_hz - below.frequency_hz) / (above->frequency_hz - below.frequency_hz);
  return below.ratio + share * (above->ratio - below.ratio);
}

const analysis::RepeatedMode& mode_of(const ModalFindings& found, std::size_t measured) {
  return found.modes[found.agreed[measured]];
}

// Every listed mode's ratio beside its frequency, as comments.
std::string ratios_found(const ModalFindings& found, const std::string& indent) {
  std::string text =
      fmt::format("{}# damping ratios, at the frequencies where they were found:\n", indent);
  for (const std::size_t i : found.agreed) {
    const analysis::RepeatedMode& mode = found.modes[i];
    text +=
        fmt::format("{}#   {:.6g} Hz: {:.5g}  {}{}{}{}\n", indent, mode.frequency_hz.value,
                    mode.damping_ratio.value, comment(mode.damping_ratio).substr(2),
                    mode.at_tap ? fmt::format("; at rest, at a tap {:.6g} Hz: {:.3g}",
                                              mode.at_tap->frequency_hz, mode.at_tap->damping_ratio)
                                : "",
                    mode.why.empty() ? "" : "; ", mode.why);
  }
  return text;
}

// The ratios of the model's modes, in order, up to the last one that was measured.
struct ModelRatios {
  std::vector<double> ratios;
  std::vector<std::size_t> interpolated;  // numbers of modes, from 1
};
ModelRatios ratios_of_model(const ModalFindings& found, const ModelComparison& model) {
  std::vector<RatioAt> known;
  std::size_t last = 0;
  for (const analysis::MatchedMode& one : model.update->matched) {
    known.push_back(
        {model.frequencies_hz[one.model], mode_of(found, one.measured).damping_ratio.value});
    last = std::max(last, one.model);
  }
  std::ranges::sort(known, {}, &RatioAt::frequency_hz);  // shapes may match modes crosswise
  ModelRatios of_model;
  for (std::size_t i = 0; i <= last; ++i) {
    of_model.ratios.push_back(interpolated(known, model.frequencies_hz[i]));
    if (!std::ranges::count(model.update->matched, i, &analysis::MatchedMode::model)) {
      of_model.interpolated.push_back(i + 1);
    }
  }
  return of_model;
}

std::string listed(const std::vector<double>& ratios) {
  std::string list;
  for (const double ratio : ratios) {
    list += fmt::format("{}{:.5g}", list.empty() ? "" : ", ", ratio);
  }
  return fmt::format("{{modal_ratios: [{}], further_ratio: {:.5g}}}", list, ratios.back());
}

// Set where a model says which of its modes was measured. One that fits nearly as well with other
// modes does not say it.
std::optional<ModelRatios> modal(const ModalFindings& found) {
  if (!found.model || !found.model->update || found.model->update->rival_pa ||
      found.model->update->matched.empty()) {
    return std::nullopt;
  }
  return ratios_of_model(found, *found.model);
}

std::string caution_of(const std::optional<ModelRatios>& by_mode, const std::string& indent) {
  if (!by_mode) {
    return fmt::format(
        "{0}# modal_ratios are not offered: they go to the model's modes in order, and which mode\n"
        "{0}# is which is known where --protocol and --stimulus name a model that matches\n",
        indent);
  }
  if (by_mode->interpolated.empty()) {
    return {};
  }
  return fmt::format("{}# modal_ratios of these modes are interpolated, not measured: {}\n", indent,
                     fmt::join(by_mode->interpolated, ", "));
}

// Precondition: at least one mode is listed.
std::string damping_of(const ModalFindings& found, const std::string& indent) {
  const std::string ratios = ratios_found(found, indent);
  const auto& rayleigh = found.rayleigh;
  if (!rayleigh) {
    return fmt::format("{}{}damping: {{ratio: {:.5g}}}\n", ratios, indent,
                       mode_of(found, 0).damping_ratio.value);
  }
  const auto by_mode = modal(found);
  const std::string by_rayleigh = fmt::format("{{alpha_per_s: {:.5g}, beta_s: {:.5g}}}",
                                              rayleigh->alpha_per_s.value, rayleigh->beta_s.value);
  const bool fits = rayleigh->fits();
  std::string text =
      ratios + caution_of(by_mode, indent) +
      fmt::format(
          "{0}# alpha_per_s {1}\n{0}# beta_s {2}\n{0}# Rayleigh's misfit of a ratio: "
          "{3:.1f} % at most{4}\n",
          indent, comment(rayleigh->alpha_per_s).substr(2), comment(rayleigh->beta_s).substr(2),
          100.0 * rayleigh->largest_misfit, fits ? "" : ": it does not fit");
  if (fits) {
    text += fmt::format("{}damping: {}\n", indent, by_rayleigh);
  }
  if (by_mode) {
    text += fmt::format("{}{}damping: {}\n", indent, fits ? "# or " : "", listed(by_mode->ratios));
  }
  if (!fits) {
    text += fmt::format("{}# {}damping: {}\n", indent, by_mode ? "or " : "", by_rayleigh);
  }
  return text;
}

std::string springs_of(const IdentifiedSprings& springs, const core::Shape& shape) {
  std::string text = fmt::format(
      "plates:\n  {}:\n    # springs: {:.4g} times the protocol's, {}\n    fixations:\n",
      springs.plate_name, springs.factor.value, comment(springs.factor).substr(2));
  for (const core::Fixation& fixation : springs.fixations) {
    text += "      - " + fixation_yaml(fixation, std::holds_alternative<core::Box>(shape)) + "\n";
  }
  return text;
}

std::string sinusoid_of(const SinusoidLaw& law, std::optional<double> loop_rate_hz) {
  if (loop_rate_hz && law.frequency_hz.value >= 0.5 * *loop_rate_hz) {
    return fmt::format("# the sinusoid of {:.5g} Hz is not below half of the protocol's rate_hz\n",
                       law.frequency_hz.value);
  }
  if (!law.amplitude_n_s_per_m) {
    return fmt::format(
        "# sinusoid: {{amplitude_n_s_per_m: unknown, decay_per_s: {:.5g}, frequency_hz: {:.5g}}}\n",
        law.decay_per_s.value, law.frequency_hz.value);
  }
  return fmt::format(
      "rendering:\n  sinusoid:\n    amplitude_n_s_per_m: {:.5g}\n    decay_per_s: {:.5g}  {}\n"
      "    frequency_hz: {:.5g}  {}\n",
      *law.amplitude_n_s_per_m, law.decay_per_s.value, comment(law.decay_per_s),
      law.frequency_hz.value, comment(law.frequency_hz));
}

std::string cautions_of(const ModelComparison& model, std::size_t found) {
  const analysis::ModelUpdate& update = *model.update;
  std::string text;
  for (const std::string& doubt : model.doubts) {
    text += fmt::format("# CAUTION: {}\n", doubt);
  }
  if (update.matched.size() < found) {
    text += fmt::format(
        "# CAUTION: only {} of the {} modes found match the model; Young's modulus rests on these. "
        "Is\n# the plate as the protocol says?\n",
        update.matched.size(), found);
  }
  if (update.rival_pa) {
    text += fmt::format("# CAUTION: {:.4g} Pa fits nearly as well, with other modes matched\n",
                        *update.rival_pa);
  }
  return text;
}

std::string comment_of_modulus(const ModelComparison& model) {
  if (model.update) {
    return comment(model.update->youngs_modulus_pa);
  }
  const bool are_springs_kept = model.is_on_springs && !model.springs;
  return fmt::format("# the protocol's: {}",
                     are_springs_kept ? "not told apart from its springs" : "no mode matched");
}

std::string three(const std::array<double, 3>& relative, double unit) {
  return fmt::format("[{:.5g}, {:.5g}, {:.5g}]", unit * relative[0], unit * relative[1],
                     unit * relative[2]);
}

// Of an orthotropic material all moduli are in proportion to the first, which was found.
std::string elasticity_of(const ModelComparison& model) {
  const core::Material& material = *model.material;
  const double modulus_pa =
      model.update ? model.update->youngs_modulus_pa.value : material.youngs_modulus_pa;
  const std::string told = comment_of_modulus(model);
  if (!material.orthotropy) {
    return fmt::format("    youngs_modulus_pa: {:.5g}  {}\n    poissons_ratio: {:.9g}\n",
                       modulus_pa, told, material.poissons_ratio);
  }
  const core::Orthotropy& elasticity = *material.orthotropy;
  return fmt::format(
      "    youngs_moduli_pa: {}  {}, of the first; all others in proportion\n"
      "    shear_moduli_pa: {}\n    poissons_ratios: {}\n    axes_rotation_rad: {}\n",
      three(elasticity.moduli, modulus_pa), told, three(elasticity.shear_moduli, modulus_pa),
      three(elasticity.poissons_ratios, 1.0), three(elasticity.rotation_rad, 1.0));
}
}  // namespace

std::string yaml_of(const ModalFindings& found) {
  std::string text = fmt::format(
      "# tapstudy identify: {}. To be pasted over the keys of the same name.\n", found.source);
  for (const std::string& other : found.others) {
    text += fmt::format("# not listed: {}\n", other);
  }
  for (std::string remark : found.remarks) {
    std::ranges::replace(remark, '\n', ' ');  // of a file's name
    text += fmt::format("# {}\n", remark);
  }
  if (found.sinusoid) {
    text += sinusoid_of(*found.sinusoid, found.loop_rate_hz);
  }
  if (found.agreed.empty()) {
    return text + "# no mode was found for certain\n";
  }
  if (!found.model) {
    return text + damping_of(found, "");
  }
  const ModelComparison& model = *found.model;
  if (model.springs) {
    text += springs_of(*model.springs, model.shape);
  }
  if (model.update) {
    text += cautions_of(model, found.agreed.size());
  }
  return text + fmt::format("materials:\n  {}:\n{}    density_kg_per_m3: {:.9g}\n{}",
                            model.material_name, elasticity_of(model),
                            model.material->density_kg_per_m3, damping_of(found, "    "));
}

namespace {
std::string samples_of(const Eigen::VectorXd& samples, double newtons_per_unit) {
  std::string text;
  for (const double sample : samples) {
    text += fmt::format("{}{:.5g}", text.empty() ? "" : ", ", newtons_per_unit * sample);
  }
  return text;
}
}  // namespace

std::string playback_of(const TapIdentification& found, double finger_kg) {
  const double newtons_per_unit = finger_kg * found.question.scale.value_or(1.0);
  std::string text = fmt::format(
      "# tapstudy identify: {} taps as the forces that give the protocol's finger the recorded\n"
      "# accelerations, those of a fingertip or stylus; of a sensor on the plate they are too "
      "large.\n# To be pasted over the key of the same name.\n"
      "recordings:\n  {}:\n    rate_hz: {:.9g}\n    taps:\n",
      found.taps.size(), found.question.stimulus, found.taps.front().whole.rate_hz);
  for (const IdentifiedTap& tap : found.taps) {
    text += fmt::format(
        "      - at_m: [{:g}, {:g}]\n        speed_m_s: {:.6g}\n        force_n: [{}]\n",
        found.question.at_m->x(), found.question.at_m->y(), *tap.speed_m_s,
        samples_of(tap.whole.samples, newtons_per_unit));
  }
  return text;
}
}  // namespace tapstudy::runner
