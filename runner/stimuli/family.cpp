#include "runner/stimuli/family.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "core/model/modes/damping.hpp"
#include "core/model/plate_model.hpp"
#include "runner/stimuli/at_its_line.hpp"
#include "runner/stimuli/model_library.hpp"
namespace tapstudy::runner {
namespace {
using protocols::AxisValues;
using protocols::PresentedStimulus;

double band_kappa_rad_per_m(const protocols::Protocol& protocol, const PresentedStimulus& member) {
  return core::kappa_rad_per_m(protocol.band_limit_hz, *member.material);
}

void check_member(const protocols::Protocol& protocol, const PresentedStimulus& member,
                  const core::BodyModes& body) {
  at_its_line(member, [&] {
    const core::PlateSpec spec = plate_spec(protocol, member);
    const Eigen::Index modes =
        (body.kappa_rad_per_m < band_kappa_rad_per_m(protocol, member)).count();
    check_has_mode(modes, spec);
    const Eigen::ArrayXd omega_rad_s = 2.0 * std::numbers::pi * body.kappa_rad_per_m.head(modes) /
                                       core::kappa_rad_per_m(1.0, spec.material);
    core::damp(spec.material.damping, omega_rad_s);
  });
}
}  // namespace

// kappa of the band limit is a product of a function of each axis, so that its extremes are found
// axis by axis.
BandEnds band_ends(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus) {
  const PresentedStimulus own = stimulus_with(protocol, stimulus);
  BandEnds ends;
  for (const protocols::AxisRange& range : stimulus.vary) {
    if (range.axis->kind != protocols::AxisKind::scaled) {
      continue;
    }
    const std::string name{range.axis->name};
    const auto kappa = [&](double value) {
      return band_kappa_rad_per_m(protocol, stimulus_with(protocol, stimulus, {{name, value}}));
    };
    const std::array<double, 3> candidates{own.values.at(name), range.from, range.to};
    // the first where all are equal: the own value of an axis that does not matter
    ends.most[name] = *std::ranges::max_element(candidates, {}, kappa);
    ends.fewest[name] = *std::ranges::min_element(candidates, {}, kappa);
  }
  return ends;
}

double largest_kappa_rad_per_m(const protocols::Protocol& protocol,
                               const protocols::Stimulus& stimulus) {
  return band_kappa_rad_per_m(
      protocol, stimulus_with(protocol, stimulus, band_ends(protocol, stimulus).most));
}

std::vector<double> poissons_ratios(const protocols::Protocol& protocol,
                                    const protocols::Stimulus& stimulus) {
  std::vector<double> ratios{stimulus.material->poissons_ratio};
  for (const protocols::AxisRange& range : stimulus.vary) {
    for (const double value : range.table) {
      ratios.push_back(stimulus_with(protocol, stimulus, {{std::string{range.axis->name}, value}})
                           .material->poissons_ratio);
    }
  }
  return ratios;
}

void check_members(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus,
                   const protocols::AxisValues& tabled, const core::BodyModes& body) {
  const BandEnds ends = band_ends(protocol, stimulus);
  for (AxisValues values : {ends.fewest, ends.most}) {
    values.insert(tabled.begin(), tabled.end());
    check_member(protocol, stimulus_with(protocol, stimulus, values), body);
  }
}
}  // namespace tapstudy::runner
