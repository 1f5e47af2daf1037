#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
  Chart chart{fmt::format("{}: correct at each level; areas by trials", person.participant_id),
              "",
              "level",
              "correct",
              range,
              {0.0, 1.0},
              is_logarithmic};
  chart.points = level_points(person.levels);
  chart.levels = {design.guess_rate};
  chart.alternative = fmt::format("Psychometric function of {}: {} correct of {} at {} levels, ",
                                  person.participant_id, person.correct.successes,
                                  person.correct.trials, person.levels.size());
  if (!person.estimate) {
    chart.alternative += "no threshold";
    return chart;
  }
  chart.line = curve_points(chart, core::PsychometricShape::weibull, person.estimate->curve);
  const Interval& interval = person.estimate->intervals.threshold;
  chart.bars = {{person.estimate->proportion_at_threshold, interval}};
  chart.alternative += "threshold " + with_interval(person.estimate->curve.threshold, interval);
  return chart;
}

Chart track_chart(const ParticipantThreshold& person, const Interval& range, bool is_logarithmic) {
  const double trials = static_cast<double>(person.track.size());
  Chart chart{fmt::format("{}: levels in order of time; open: wrong", person.participant_id),
              fmt::format("Levels of {} over {} trials, from {} to {}", person.participant_id,
                          person.track.size(), rounded(person.track.front().level),
                          rounded(person.track.back().level)),
              "trial",
              "level",
              {0.0, trials + 1.0},
              range,
              false,
              is_logarithmic};
  constexpr double small = 0.2;
  for (const TrackPoint& point : person.track) {
    chart.points.push_back(
        {static_cast<double>(point.number), point.level, small, !point.is_correct});
  }
  chart.line = chart.points;
  return chart;
}
// Over a logarithmic axis the area below the curve is 1 per decade.
Chart posterior_chart(const ParticipantThreshold& person, const PosteriorEstimates& posterior,
                      const Interval& range) {
  const Marginal& marginal = posterior.position;
  const double most = *std::ranges::max_element(marginal.density);
  Chart chart{
      fmt::format("{}: posterior of the threshold, with its 95 % credible interval",
                  person.participant_id),
      fmt::format("Posterior density of the threshold of {}, median {}", person.participant_id,
                  with_interval(posterior.threshold, posterior.threshold_interval)),
      "threshold",
      "density per decade",
      range,
      {0.0, 1.05 * most},
      true};
  for (std::size_t i = 0; i < marginal.at.size(); ++i) {
    const double threshold = std::pow(10.0, marginal.at[i]);
    if (threshold >= range.low && threshold <= range.high) {
      chart.line.push_back({threshold, marginal.density[i]});
    }
  }
  chart.bars = {{0.02 * most, posterior.threshold_interval}};
  return chart;
}

// From the lowest to the highest threshold that is not negligible.
Interval range_of_posteriors(const ThresholdResults& results) {
  constexpr double negligible = 1e-3;
  std::vector<double> thresholds;
  for (const ParticipantThreshold& person : results.participants) {
    if (person.posterior) {
      const Marginal& marginal = person.posterior->position;
      const double most = *std::ranges::max_element(marginal.density);
      for (std::size_t i = 0; i < marginal.at.size(); ++i) {
        if (marginal.density[i] > negligible * most) {
          thresholds.push_back(std::pow(10.0, marginal.at[i]));
        }
      }
    }
  }
  return thresholds.empty() ? Interval{} : range_of(thresholds, true);
}
}  // namespace

std::vector<Chart> threshold_charts(const BlockDesign& design, const ThresholdResults& results) {
  const std::vector<double> levels = levels_of(results);
  const bool is_logarithmic = std::ranges::all_of(levels, [](double level) { return level > 0.0; });
  const Interval range = range_of(levels, is_logarithmic);
  const Interval thresholds = range_of_posteriors(results);
  std::vector<Chart> charts;
  for (const ParticipantThreshold& person : results.participants) {
    if (!person.track.empty()) {
      charts.push_back(function_chart(person, design, range, is_logarithmic));
      charts.back().begins_row = true;
      charts.push_back(track_chart(person, range, is_logarithmic));
      if (person.posterior) {
        charts.push_back(posterior_chart(person, *person.posterior, thresholds));
      }
    }
  }
  return charts;
}
}  // namespace tapstudy::analysis
