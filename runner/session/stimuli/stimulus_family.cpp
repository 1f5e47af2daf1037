#include "runner/session/stimuli/stimulus_family.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "core/model/modes/damping.hpp"
#include "core/model/plate_model.hpp"
#include "runner/session/stimuli/model_library.hpp"
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

// By bisection of the axis: kappa of the limit is monotonic along each.
std::vector<double> band_crossings(const protocols::Protocol& protocol,
                                   const protocols::Stimulus& stimulus,
                                   const protocols::AxisRange& range, const core::BodyModes& body) {
  constexpr int halvings = 40;
  if (range.axis->kind != protocols::AxisKind::scaled) {
    return {};
  }
  const auto limit_at = [&](double share) {
    return band_kappa_rad_per_m(
        protocol,
        stimulus_with(protocol, stimulus, {{std::string{range.axis->name}, range.at(share)}}));
  };
  std::vector<double> crossings;
  for (const double kappa : body.kappa_rad_per_m) {
    const bool is_in_at_first = kappa < limit_at(0.0);
    if (is_in_at_first == (kappa < limit_at(1.0))) {
      continue;
    }
    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < halvings; ++i) {
      const double middle = (low + high) / 2.0;
      ((kappa < limit_at(middle)) == is_in_at_first ? low : high) = middle;
    }
    crossings.push_back(range.at(high));
  }
  std::ranges::sort(crossings);
  return crossings;
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

double largest_contact_stiffness_n_per_m(const protocols::Protocol& protocol) {
  double largest = protocol.rendering.penalty_stiffness_n_per_m;
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    largest =
        std::max(largest, stimulus_with(protocol, stimulus).rendering.penalty_stiffness_n_per_m);
    for (const protocols::AxisRange& range : stimulus.vary) {
      const auto member =
          stimulus_with(protocol, stimulus, {{std::string{range.axis->name}, range.to}});
      largest = std::max(largest, member.rendering.penalty_stiffness_n_per_m);
    }
  }
  return largest;
}
}  // namespace tapstudy::runner
