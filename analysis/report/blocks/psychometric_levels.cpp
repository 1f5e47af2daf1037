#include "analysis/report/blocks/psychometric_levels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
double to_nine_digits(double level) {
  if (level == 0.0 || !std::isfinite(level)) {
    return level;
  }
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(level))) - 8.0);
  return std::round(level / unit) * unit;
}
}  // namespace

std::optional<double> comparison_level(const BlockDesign& design,
                                       const results::AnswerRow& answer) {
  const auto comparison =
      std::ranges::find_if(answer.alternatives, &results::AlternativeRow::is_comparison);
  if (comparison == answer.alternatives.end() ||
      std::ranges::all_of(answer.alternatives, &results::AlternativeRow::is_comparison)) {
    return std::nullopt;
  }
  const auto value = comparison->axis_values.find(design.axis->name.key);
  if (value == comparison->axis_values.end()) {
    throw core::InvalidInput{
        fmt::format("block '{}': the comparison of {} in trial {} has no value of '{}'",
                    design.name, answer.participant_id, answer.number, design.axis->name.key)};
  }
  return to_nine_digits(design.axis->level_of(value->second));
}

double from_log(double log) {
  return std::pow(10.0, log);
}

void count_at(std::vector<Level>& levels, double level, bool is_success) {
  auto at = std::ranges::lower_bound(levels, level, {}, &Level::value);
  if (at == levels.end() || at->value != level) {
    at = levels.insert(at, {level, {}});
  }
  at->answers.add(is_success);
}

void add_track_point(std::vector<TrackPoint>& points, const results::AnswerRow& answer,
                     double level, bool is_success) {
  points.push_back(
      {static_cast<int>(points.size()) + 1, answer.track.value_or(0), level, is_success});
}

ReportTable tracks_table(const std::string& success, const std::string& success_key) {
  ReportTable table{
      "tracks",
      "Levels in order of time",
      {column("participant", "participant_id"), column("trial", "trial"), column("track", "track"),
       column("level", "level"), column(success, success_key)}};
  table.shown_in = programs_only;
  return table;
}

void add_track_rows(const std::string& participant, const std::vector<TrackPoint>& points,
                    ReportTable& table) {
  for (const TrackPoint& point : points) {
    table.rows.push_back({word(participant), count(point.number),
                          point.track > 0 ? count(point.track) : nothing(table.columns[2]),
                          number(point.level), flag(point.is_success)});
  }
}

std::vector<Chart> track_charts(const std::string& participant,
                                const std::vector<TrackPoint>& points, const Interval& range,
                                bool is_logarithmic, const std::string& words_of_open) {
  std::map<int, std::vector<ChartPoint>> of_track;
  for (const TrackPoint& point : points) {
    constexpr double small = 0.2;
    of_track[point.track].push_back(
        {static_cast<double>(point.number), point.level, small, !point.is_success});
  }
  std::vector<Chart> charts;
  for (auto& [track, marks] : of_track) {
    const std::string name =
        of_track.size() > 1 ? fmt::format("{}, track {}", participant, track) : participant;
    Chart chart{fmt::format("{}: levels in order of time; open: {}", name, words_of_open),
                fmt::format("Levels of {} over {} trials, from {} to {}", name, marks.size(),
                            rounded(marks.front().y), rounded(marks.back().y)),
                "trial",
                "level",
                {0.0, static_cast<double>(points.size()) + 1.0},
                range,
                false,
                is_logarithmic};
    chart.line = marks;
    chart.points = std::move(marks);
    charts.push_back(std::move(chart));
  }
  return charts;
}

std::vector<ChartPoint> level_points(const std::vector<Level>& levels) {
  std::int64_t most = 1;
  for (const Level& level : levels) {
    most = std::max(most, level.answers.trials);
  }
  std::vector<ChartPoint> points;
  for (const Level& level : levels) {
    points.push_back({level.value, level.answers.value(),
                      static_cast<double>(level.answers.trials) / static_cast<double>(most)});
  }
  return points;
}

std::vector<ChartPoint> curve_points(const Chart& chart, core::PsychometricShape shape,
                                     const PsychometricCurve& curve) {
  constexpr int pieces = 60;
  const auto& [low, high] = chart.x_range;
  std::vector<ChartPoint> points;
  for (int i = 0; i <= pieces; ++i) {
    const double along = static_cast<double>(i) / pieces;
    const double x =
        chart.is_x_logarithmic ? low * std::pow(high / low, along) : low + along * (high - low);
    if (x >= 0.0 || !core::row_of(shape).is_logarithmic) {
      points.push_back(
          {x, core::proportion(shape, x, curve.threshold, curve.slope, curve.guess, curve.lapse)});
    }
  }
  return points;
}
}  // namespace tapstudy::analysis
