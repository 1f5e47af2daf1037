#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/thresholds/threshold_tables.hpp"
namespace tapstudy::analysis {
namespace {
constexpr int points_of_curve = 60;

std::vector<double> levels_of(const ThresholdResults& results) {
  std::vector<double> levels;
  for (const ParticipantThreshold& person : results.participants) {
    for (const Level& level : person.levels) {
      levels.push_back(level.value);
    }
  }
  return levels;
}

std::vector<ChartPoint> curve_points(const Chart& chart, const PsychometricCurve& curve) {
  std::vector<ChartPoint> line;
  for (int i = 0; i <= points_of_curve; ++i) {
    const double along = static_cast<double>(i) / points_of_curve;
    const double x =
        chart.is_x_logarithmic
            ? chart.x_range.low * std::pow(chart.x_range.high / chart.x_range.low, along)
            : chart.x_range.low + along * (chart.x_range.high - chart.x_range.low);
    if (x >= 0.0) {
      line.push_back({x, core::proportion(core::PsychometricShape::weibull, x, curve.threshold,
                                          curve.slope, curve.guess, curve.lapse)});
    }
  }
  return line;
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
  std::int64_t most = 1;
  for (const Level& level : person.levels) {
    most = std::max(most, level.answers.trials);
  }
  for (const Level& level : person.levels) {
    chart.points.push_back({level.value, level.answers.value(),
                            static_cast<double>(level.answers.trials) / static_cast<double>(most)});
  }
  chart.levels = {design.guess_rate};
  chart.alternative = fmt::format("Psychometric function of {}: {} correct of {} at {} levels, ",
                                  person.participant_id, person.correct.successes,
                                  person.correct.trials, person.levels.size());
  if (!person.estimate) {
    chart.alternative += "no threshold";
    return chart;
  }
  chart.line = curve_points(chart, person.estimate->curve);
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
}  // namespace

std::vector<Chart> threshold_charts(const BlockDesign& design, const ThresholdResults& results) {
  const std::vector<double> levels = levels_of(results);
  const bool is_logarithmic = std::ranges::all_of(levels, [](double level) { return level > 0.0; });
  const Interval range = range_of(levels, is_logarithmic);
  std::vector<Chart> charts;
  for (const ParticipantThreshold& person : results.participants) {
    if (!person.track.empty()) {
      charts.push_back(function_chart(person, design, range, is_logarithmic));
      charts.push_back(track_chart(person, range, is_logarithmic));
    }
  }
  return charts;
}
}  // namespace tapstudy::analysis
