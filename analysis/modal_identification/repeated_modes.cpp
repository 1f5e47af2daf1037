#include "analysis/modal_identification/repeated_modes.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>

#include "analysis/participants/mean_proportion.hpp"
#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::size_t min_taps_to_resample = 5;
constexpr int bootstrap_draws = 2000;
constexpr std::uint64_t bootstrap_seed = 1;
constexpr double same_frequency = 0.02;

struct Sighting {
  std::size_t tap{};
  const TapMode* mode{};
  double degrees_of_freedom{};
};
using Sightings = std::vector<Sighting>;

double frequency_of(const Sighting& one) {
  return one.mode->fitted.pole.frequency_hz;
}

Sightings sightings_in(const std::vector<TapModes>& taps) {
  Sightings all;
  for (std::size_t i = 0; i < taps.size(); ++i) {
    for (const TapMode& mode : taps[i].modes) {
      all.push_back({i, &mode, taps[i].fit.degrees_of_freedom});
    }
  }
  std::ranges::stable_sort(all, std::ranges::greater{},
                           [](const Sighting& one) { return one.mode->fitted.significance; });
  return all;
}

bool is_of(const Sightings& group, const Sighting& one) {
  const FittedMode& first = group.front().mode->fitted;
  const double tolerance =
      std::max({same_frequency * first.pole.frequency_hz,
                std::abs(first.pole.damping_ratio) / 3.0 * first.pole.frequency_hz,
                4.0 * std::hypot(first.frequency_error_hz, one.mode->fitted.frequency_error_hz)});
  return std::abs(frequency_of(one) - first.pole.frequency_hz) <= tolerance &&
         std::ranges::find(group, one.tap, &Sighting::tap) == group.end();
}

double norm_of(const std::vector<double>& errors) {
  double squares = 0.0;
  for (const double error : errors) {
    squares += error * error;
  }
  return std::sqrt(squares);
}

std::vector<Sightings> groups_of(const Sightings& all) {
  std::vector<Sightings> groups;
  for (const Sighting& one : all) {
    Sightings* nearest = nullptr;
    double least = 0.0;
    for (Sightings& group : groups) {
      const double distance = std::abs(frequency_of(group.front()) - frequency_of(one));
      if (is_of(group, one) && (nearest == nullptr || distance < least)) {
        nearest = &group;
        least = distance;
      }
    }
    if (nearest == nullptr) {
      nearest = &groups.emplace_back();
    }
    nearest->push_back(one);
  }
  return groups;
}

Sightings of_standing(const Sightings& group, Standing standing) {
  Sightings some;
  std::ranges::copy_if(group, std::back_inserter(some),
                       [&](const Sighting& one) { return one.mode->standing == standing; });
  return some;
}

// What the channels of one impact say, averaged.
struct Shown {
  std::vector<double> frequencies_hz;
  std::vector<double> ratios;
  std::vector<double> frequency_errors_hz;
  std::vector<double> ratio_errors;
};
Shown shown_by(const Sightings& group, const std::vector<int>& impacts) {
  std::map<int, Sightings> by_impact;
  for (const Sighting& one : group) {
    by_impact[impacts.empty() ? static_cast<int>(one.tap) : impacts[one.tap]].push_back(one);
  }
  Shown shown;
  for (const auto& [impact, channels] : by_impact) {
    const auto count = static_cast<double>(channels.size());
    const auto of = [&, &channels = channels](auto value_of) {
      std::vector<double> values;
      std::ranges::transform(channels, std::back_inserter(values),
                             [&](const Sighting& one) { return value_of(one.mode->fitted); });
      return values;
    };
    const auto mean = [&](const std::vector<double>& values) {
      return std::accumulate(values.begin(), values.end(), 0.0) / count;
    };
    shown.frequencies_hz.push_back(
        mean(of([](const FittedMode& fitted) { return fitted.pole.frequency_hz; })));
    shown.ratios.push_back(
        mean(of([](const FittedMode& fitted) { return fitted.pole.damping_ratio; })));
    shown.frequency_errors_hz.push_back(
        norm_of(of([](const FittedMode& fitted) { return fitted.frequency_error_hz; })) / count);
    shown.ratio_errors.push_back(
        norm_of(of([](const FittedMode& fitted) { return fitted.ratio_error; })) / count);
  }
  return shown;
}

RepeatedMode summary_of(const Sightings& group, std::size_t taps, const std::vector<int>& impacts) {
  const Sightings agreed = of_standing(group, Standing::agreed);
  const Sightings lines = of_standing(group, Standing::line);
  RepeatedMode mode;
  mode.taps = static_cast<int>(group.size());
  mode.agreed = static_cast<int>(agreed.size());
  const Sightings* shown = &group;
  if (2 * lines.size() > group.size()) {
    mode.standing = Standing::line;
    mode.why = lines.front().mode->why;
    shown = &lines;
  } else if (2 * agreed.size() >= group.size() && agreed.size() >= std::min<std::size_t>(2, taps)) {
    mode.standing = Standing::agreed;
    shown = &agreed;
  } else {
    const Sightings doubtful = of_standing(group, Standing::doubtful);
    mode.why = doubtful.empty() ? "in one tap only" : doubtful.front().mode->why;
  }
  const Shown of_impacts = shown_by(*shown, impacts);
  mode.frequencies_hz = of_impacts.frequencies_hz;
  mode.ratios = of_impacts.ratios;
  const double freedom = shown->front().degrees_of_freedom;
  mode.frequency_hz =
      estimate_over_taps(mode.frequencies_hz, of_impacts.frequency_errors_hz, freedom);
  mode.damping_ratio = estimate_over_taps(mode.ratios, of_impacts.ratio_errors, freedom);
  return mode;
}
}  // namespace

Estimate estimate_over_taps(const std::vector<double>& values, const std::vector<double>& errors,
                            double degrees_of_freedom_of_one) {
  const auto count = static_cast<double>(values.size());
  Estimate estimate;
  double freedom = degrees_of_freedom_of_one;
  estimate.value = values.front();
  estimate.standard_error = errors.front();
  double error = errors.front();
  if (values.size() > 1) {
    const MeanAndSpread over = mean_and_spread(values);
    freedom = count - 1.0;
    estimate.value = over.mean;
    error = over.standard_deviation / std::sqrt(count);
    estimate.standard_error = std::max(error, norm_of(errors) / count);
  }
  const double half = t_quantile(0.975, freedom) * error;
  estimate.interval = {estimate.value - half, estimate.value + half};
  if (values.size() >= min_taps_to_resample) {
    estimate.bootstrap =
        bca_interval(values, bootstrap_draws, bootstrap_seed, expanded_tail(values.size()));
  }
  return estimate;
}

std::vector<RepeatedMode> modes_over_taps(const std::vector<TapModes>& taps,
                                          const std::vector<int>& impacts) {
  std::vector<RepeatedMode> modes;
  for (const Sightings& group : groups_of(sightings_in(taps))) {
    modes.push_back(summary_of(group, taps.size(), impacts));
  }
  std::ranges::sort(modes, {}, [](const RepeatedMode& mode) { return mode.frequency_hz.value; });
  return modes;
}
}  // namespace tapstudy::analysis
