#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/psychometric/levels.hpp"
#include "analysis/tables/psychometric_chart.hpp"
#include "analysis/thresholds/threshold_tables.hpp"
namespace tapstudy::analysis {
namespace {
std::vector<double> levels_of(const ThresholdResults& results) {
  std::vector<double> levels;
  for (const ParticipantThreshold& person : results.participants) {
    for (const Level& level : person.levels) {
      levels.push_back(level.value);
    }
  }
  return levels;
}

Chart function_chart(const ParticipantThreshold& person, const BlockDesign& design,
                     const Interval& range, bool is_logarithmic) {
  Chart chart{fmt::format("{}: correct at each level, areas by trials; curve: fit; bar: "
                          "threshold, 95 %; dashed: guessing",
                          person.participant_id),
              "",
              "level",
              "correct",
              range,
              {0.0, 1.0},
              is_logarithmic};
  chart.points = level_points(person.levels);
  if (!design.has_own_guess_rate) {
    chart.levels = {design.guess_rate};
  } else if (person.estimate) {
    chart.levels = {person.estimate->curve.guess};
  }
  chart.alternative = fmt::format("Psychometric function of {}: {} correct of {} at {} levels, ",
                                  person.participant_id, person.correct.successes,
                                  person.correct.trials, person.levels.size());
  if (!person.estimate) {
    chart.alternative += "no threshold";
    return chart;
  }
  chart.line = curve_points(chart, design.shape, person.estimate->curve);
  const Interval& interval = person.estimate->intervals.threshold;
  chart.bars = {{person.estimate->proportion_at_threshold, interval}};
  chart.alternative += "threshold " + with_interval(person.estimate->curve.threshold, interval);
  return chart;
}

// Over a logarithmic axis the area below the curve is 1 per decade.
Chart posterior_chart(const ParticipantThreshold& person, const PosteriorEstimates& posterior,
                      core::PsychometricShape shape, const Interval& range) {
  const Marginal& marginal = posterior.position;
  const double most = *std::ranges::max_element(marginal.density);
  const bool is_logarithmic = core::row_of(shape).is_logarithmic;
  Chart chart{
      fmt::format("{}: posterior of the threshold, with its 95 % credible interval",
                  person.participant_id),
      fmt::format("Posterior density of the threshold of {}, median {}", person.participant_id,
                  with_interval(posterior.threshold, posterior.threshold_interval)),
      "threshold",
      is_logarithmic ? "density per decade" : "density",
      range,
      {0.0, 1.05 * most},
      is_logarithmic};
  for (std::size_t i = 0; i < marginal.at.size(); ++i) {
    const double threshold = from_axis(shape, marginal.at[i]);
    if (threshold >= range.low && threshold <= range.high) {
      chart.line.push_back({threshold, marginal.density[i]});
    }
  }
  chart.bars = {{0.02 * most, posterior.threshold_interval}};
  return chart;
}

// From the lowest to the highest threshold that is not negligible.
Interval range_of_posteriors(const ThresholdResults& results, core::PsychometricShape shape) {
  constexpr double negligible = 1e-3;
  std::vector<double> thresholds;
  for (const ParticipantThreshold& person : results.participants) {
    if (person.posterior) {
      const Marginal& marginal = person.posterior->position;
      const double most = *std::ranges::max_element(marginal.density);
      for (std::size_t i = 0; i < marginal.at.size(); ++i) {
        if (marginal.density[i] > negligible * most) {
          thresholds.push_back(from_axis(shape, marginal.at[i]));
        }
      }
    }
  }
  return thresholds.empty() ? Interval{} : range_of(thresholds, core::row_of(shape).is_logarithmic);
}
}  // namespace

std::vector<Chart> threshold_charts(const BlockDesign& design, const ThresholdResults& results) {
  const std::vector<double> levels = levels_of(results);
  const bool is_logarithmic = std::ranges::all_of(levels, [](double level) { return level > 0.0; });
  const Interval range = range_of(levels, is_logarithmic);
  const Interval thresholds = range_of_posteriors(results, design.shape);
  std::vector<Chart> charts;
  for (const ParticipantThreshold& person : results.participants) {
    if (!person.track.empty()) {
      charts.push_back(function_chart(person, design, range, is_logarithmic));
      charts.back().begins_row = true;
      for (Chart& chart :
           track_charts(person.participant_id, person.track, range, is_logarithmic, "wrong")) {
        charts.push_back(std::move(chart));
      }
      if (person.posterior) {
        charts.push_back(posterior_chart(person, *person.posterior, design.shape, thresholds));
      }
    }
  }
  return charts;
}
}  // namespace tapstudy::analysis
