#pragma once
#include <string>
#include <vector>

#include "analysis/tables/cells.hpp"
#include "analysis/tables/chart.hpp"
#include "results/rows.hpp"
namespace tapstudy::analysis {
// The levels that procedures presented to a participant, in the order of time.
struct TrackPoint {
  int number{};  // of the trial with a comparison beside a standard, from 1
  int track{};   // of the block's procedures, from 1; 0: not known
  double level{};
  bool is_success{};
};
void add_track_point(std::vector<TrackPoint>& points, const results::AnswerRow& answer,
                     double level, bool is_success);

// One row a trial: participant, trial, track, level, success (under the key given).
ReportTable tracks_table(const std::string& success, const std::string& success_key);
void add_track_rows(const std::string& participant, const std::vector<TrackPoint>& points,
                    ReportTable& table);

// A figure of each track; failures are open marks.
std::vector<Chart> track_charts(const std::string& participant,
                                const std::vector<TrackPoint>& points, const Interval& range,
                                bool is_logarithmic, const std::string& words_of_open);
}  // namespace tapstudy::analysis
