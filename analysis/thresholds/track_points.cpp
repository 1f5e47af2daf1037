#include "analysis/thresholds/track_points.hpp"

#include <fmt/format.h>

#include <map>
namespace tapstudy::analysis {
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
  table.is_for_programs = true;
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
}  // namespace tapstudy::analysis
