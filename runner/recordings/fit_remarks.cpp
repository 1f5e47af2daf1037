#include "runner/recordings/fit_remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
namespace tapstudy::runner {
namespace {
constexpr double min_explained = 0.998;
constexpr double max_over_noise = 4.0;
constexpr double min_assurance = 0.5;
constexpr Eigen::Index few_values = 500;
constexpr Eigen::Index few_share = 4;  // samples to a value
}  // namespace

std::vector<std::string> remarks_on_residuals(const std::vector<IdentifiedTap>& taps) {
  std::vector<std::string> remarks;
  for (const IdentifiedTap& tap : taps) {
    const analysis::DecayFit& fit = tap.modes.fit;
    if (!fit.has_converged) {
      remarks.push_back(
          fmt::format("{}: the fit of the tap at {:.3f} s did not converge", tap.file, tap.time_s));
    }
    const double over_noise = fit.noise / std::max(tap.noise_rms, 1e-300);
    if (fit.explained < min_explained && over_noise > max_over_noise) {
      remarks.push_back(fmt::format(
          "{}: of the tap at {:.3f} s the modes explain only {:.1f} % of the energy, and what is "
          "left is {:.0f} times the recording's noise (struck twice, limited by the amplifier, or "
          "not linear?): do not rely on its modes",
          tap.file, tap.time_s, 100.0 * fit.explained, over_noise));
    }
  }
  return remarks;
}

std::vector<std::string> remarks_on_scatter(const std::vector<analysis::RepeatedMode>& modes) {
  constexpr double improbable = 1e-3;
  std::vector<std::string> remarks;
  for (const analysis::RepeatedMode& mode : modes) {
    if (mode.standing == analysis::Standing::agreed && mode.scatter_p.value_or(1.0) < improbable) {
      remarks.push_back(fmt::format(
          "the mode at {:.6g} Hz scatters more over the taps than their noise explains (p = "
          "{:.1g}): "
          "two modes too close to be told apart, or a plate that is not linear; its intervals may "
          "hold neither",
          mode.frequency_hz.value, *mode.scatter_p));
    }
  }
  return remarks;
}

std::vector<std::string> remarks_on_resolution(const std::vector<IdentifiedTap>& taps) {
  std::vector<std::string> remarks;
  std::set<std::string> told;
  for (const IdentifiedTap& tap : taps) {
    const Eigen::VectorXd& samples = tap.decay.samples;
    const std::set<double> values{samples.begin(), samples.end()};
    const auto different = static_cast<Eigen::Index>(values.size());
    if (different < few_values && few_share * different < samples.size() &&
        told.insert(tap.file + tap.channel).second) {
      remarks.push_back(fmt::format(
          "{}: samples have only some {} different values: the intervals of damping ratios may be "
          "too narrow, above all of modes that ring for long (use more of the converter's range)",
          tap.file, different));
    }
  }
  return remarks;
}

std::vector<std::string> remarks_on_shapes(const analysis::ModelUpdate& update,
                                           const TapIdentification& identified) {
  std::vector<std::string> remarks;
  for (const analysis::MatchedMode& one : update.matched) {
    if (one.assurance && *one.assurance < min_assurance) {
      remarks.push_back(fmt::format(
          "the mode at {:.6g} Hz does not have the shape of the model's (MAC {:.2g}): are places, "
          "force or speeds right?",
          identified.modes[identified.agreed[one.measured]].frequency_hz.value, *one.assurance));
    }
  }
  return remarks;
}
}  // namespace tapstudy::runner
