#include "analysis/modal/modes/repeated_modes.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <set>

#include "analysis/modal/modes/assignment.hpp"
#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double same_frequency = 0.02;

struct ModeObservation {
  std::size_t tap{};
  const TapMode* mode{};
  double degrees_of_freedom{};
};
using ModeObservations = std::vector<ModeObservation>;

double frequency_of(const ModeObservation& one) {
  return one.mode->fitted.pole.frequency_hz;
}

ModeObservations observations_in(const TapModes& tap, std::size_t number) {
  ModeObservations all;
  for (const TapMode& mode : tap.modes) {
    all.push_back({number, &mode, tap.fit.degrees_of_freedom});
  }
  return all;
}

const FittedMode& most_significant(const ModeObservations& group) {
  return std::ranges::max_element(
             group, {}, [](const ModeObservation& one) { return one.mode->fitted.significance; })
      ->mode->fitted;
}

// The distance between frequencies relative to the tolerance of one mode: up to 1 for the same
// mode.
double distance(const ModeObservations& group, const ModeObservation& one) {
  const FittedMode& known = most_significant(group);
  const double tolerance = frequency_tolerance_hz(
      known.pole, same_frequency,
      std::hypot(known.frequency_error_hz, one.mode->fitted.frequency_error_hz));
  return std::abs(frequency_of(one) - known.pole.frequency_hz) / tolerance;
}

double norm_of(const std::vector<double>& errors) {
  double squares = 0.0;
  for (const double error : errors) {
    squares += error * error;
  }
  return std::sqrt(squares);
}

// Each of one tap's modes is of another group, or of a new one: together so that they are nearest.
void add_to_groups(const ModeObservations& of_tap, std::vector<ModeObservations>& groups) {
  constexpr double never = 1e3;
  const auto rows = static_cast<Eigen::Index>(of_tap.size());
  const auto known = static_cast<Eigen::Index>(groups.size());
  Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(rows, known + rows, never);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < known; ++j) {
      const double far =
          distance(groups[static_cast<std::size_t>(j)], of_tap[static_cast<std::size_t>(i)]);
      cost(i, j) = far <= 1.0 ? far : never;
    }
    cost(i, known + i) = 1.0;
  }
  const std::vector<std::size_t> chosen = least_cost_assignment(cost);
  for (std::size_t i = 0; i < of_tap.size(); ++i) {
    if (chosen[i] < static_cast<std::size_t>(known)) {
      groups[chosen[i]].push_back(of_tap[i]);
    } else {
      groups.push_back({of_tap[i]});
    }
  }
}

// Taps that show most modes come first: they tell close ones apart.
std::vector<ModeObservations> groups_of(const std::vector<TapModes>& taps) {
  std::vector<ModeObservations> of_taps;
  for (std::size_t i = 0; i < taps.size(); ++i) {
    of_taps.push_back(observations_in(taps[i], i));
  }
  std::ranges::stable_sort(of_taps, std::ranges::greater{}, &ModeObservations::size);
  std::vector<ModeObservations> groups;
  for (const ModeObservations& of_tap : of_taps) {
    add_to_groups(of_tap, groups);
  }
  return groups;
}

ModeObservations of_standing(const ModeObservations& group, Standing standing) {
  ModeObservations some;
  std::ranges::copy_if(group, std::back_inserter(some),
                       [&](const ModeObservation& one) { return one.mode->standing == standing; });
  return some;
}

// One mode in each impact, averaged over its channels.
struct ImpactMeans {
  std::vector<double> frequencies_hz;
  std::vector<double> ratios;
  std::vector<double> frequency_errors_hz;
  std::vector<double> ratio_errors;
};
ImpactMeans impact_means_of(const ModeObservations& group, const std::vector<int>& impacts) {
  std::map<int, ModeObservations> by_impact;
  for (const ModeObservation& one : group) {
    by_impact[impacts.empty() ? static_cast<int>(one.tap) : impacts[one.tap]].push_back(one);
  }
  ImpactMeans means;
  for (const auto& [impact, channels] : by_impact) {
    const auto count = static_cast<double>(channels.size());
    const auto of = [&, &channels = channels](auto value_of) {
      std::vector<double> values;
      std::ranges::transform(channels, std::back_inserter(values), [&](const ModeObservation& one) {
        return value_of(one.mode->fitted);
      });
      return values;
    };
    const auto mean = [&](const std::vector<double>& values) {
      return std::accumulate(values.begin(), values.end(), 0.0) / count;
    };
    means.frequencies_hz.push_back(
        mean(of([](const FittedMode& fitted) { return fitted.pole.frequency_hz; })));
    means.ratios.push_back(
        mean(of([](const FittedMode& fitted) { return fitted.pole.damping_ratio; })));
    means.frequency_errors_hz.push_back(
        norm_of(of([](const FittedMode& fitted) { return fitted.frequency_error_hz; })) / count);
    means.ratio_errors.push_back(
        norm_of(of([](const FittedMode& fitted) { return fitted.ratio_error; })) / count);
  }
  return means;
}

std::optional<double> scatter_p_of(const std::vector<double>& values,
                                   const std::vector<double>& errors) {
  const bool are_known = std::ranges::all_of(errors, [](double error) { return error > 0.0; });
  if (values.size() < 3 || !are_known) {
    return std::nullopt;
  }
  double weights = 0.0;
  double mean = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    weights += 1.0 / (errors[i] * errors[i]);
    mean += values[i] / (errors[i] * errors[i]);
  }
  mean /= weights;
  double chi_squared = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double deviation = (values[i] - mean) / errors[i];
    chi_squared += deviation * deviation;
  }
  return chi_squared_p(chi_squared, static_cast<double>(values.size()) - 1.0);
}

// Taps are as good a witness as orders of a pencil: what most of them show, far above their noise,
// is a mode even where the pencil does not settle.
bool most_taps_show(const ModeObservations& group, std::size_t taps) {
  constexpr std::size_t least_taps = 3;
  constexpr double far_above_noise = 10.0 * min_significance;
  const auto shown =
      static_cast<std::size_t>(std::ranges::count_if(group, [](const ModeObservation& one) {
        return one.mode->by_rational_fit && one.mode->standing != Standing::line &&
               one.mode->fitted.pole.damping_ratio > 0.0 &&
               one.mode->fitted.significance >= far_above_noise;
      }));
  return shown >= least_taps && 3 * shown >= 2 * taps;
}

// Sensors of one impact show what they can: a mode has nodes, and one of them may lie on one.
std::size_t different_impacts(std::size_t taps, const std::vector<int>& impacts) {
  return impacts.empty() ? taps : std::set<int>{impacts.begin(), impacts.end()}.size();
}

RepeatedMode summary_of(const ModeObservations& group, std::size_t taps,
                        const std::vector<int>& impacts) {
  const std::size_t least_agreed = std::min<std::size_t>(2, different_impacts(taps, impacts));
  const ModeObservations agreed = of_standing(group, Standing::agreed);
  const ModeObservations lines = of_standing(group, Standing::line);
  RepeatedMode mode;
  mode.taps = static_cast<int>(group.size());
  mode.agreed = static_cast<int>(agreed.size());
  const ModeObservations* shown = &group;
  if (2 * lines.size() > group.size()) {
    mode.standing = Standing::line;
    mode.why = lines.front().mode->why;
    shown = &lines;
  } else if (2 * agreed.size() >= group.size() && agreed.size() >= least_agreed) {
    mode.standing = Standing::agreed;
    shown = &agreed;
  } else if (most_taps_show(group, taps)) {
    mode.standing = Standing::agreed;
    mode.agreed = mode.taps;
  } else {
    const ModeObservations doubtful = of_standing(group, Standing::doubtful);
    mode.why = doubtful.empty() ? "in one tap only" : doubtful.front().mode->why;
  }
  const ImpactMeans of_impacts = impact_means_of(*shown, impacts);
  std::vector<double> amplitudes;
  for (const ModeObservation& one : *shown) {
    amplitudes.push_back(one.mode->fitted.amplitude);
  }
  mode.amplitude = quantile(amplitudes, 0.5);
  const double freedom = shown->front().degrees_of_freedom;
  mode.frequency_hz =
      estimate_over_taps(of_impacts.frequencies_hz, of_impacts.frequency_errors_hz, freedom);
  mode.scatter_p = scatter_p_of(of_impacts.frequencies_hz, of_impacts.frequency_errors_hz);
  mode.damping_ratio = estimate_over_taps(of_impacts.ratios, of_impacts.ratio_errors, freedom);
  mode.degrees_of_freedom =
      of_impacts.ratios.size() > 1 ? static_cast<double>(of_impacts.ratios.size()) - 1.0 : freedom;
  return mode;
}
}  // namespace

std::vector<RepeatedMode> modes_over_taps(const std::vector<TapModes>& taps,
                                          const std::vector<int>& impacts) {
  std::vector<RepeatedMode> modes;
  for (const ModeObservations& group : groups_of(taps)) {
    modes.push_back(summary_of(group, taps.size(), impacts));
  }
  std::ranges::sort(modes, {}, [](const RepeatedMode& mode) { return mode.frequency_hz.value; });
  return modes;
}
}  // namespace tapstudy::analysis
