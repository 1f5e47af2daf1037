#pragma once
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/document/block_design.hpp"
#include "analysis/report/document/cells.hpp"
#include "analysis/report/document/chart.hpp"
#include "analysis/statistics/psychometric/fit.hpp"
#include "analysis/statistics/psychometric/likelihood.hpp"
#include "results/rows.hpp"
namespace tapstudy::analysis {
// VariedAxis::level_of the first comparison of an answered trial, to nine digits, because values of
// one stimulus differ in their last ones where they are products; unset where no comparison stood
// beside a standard. Throws InvalidInput if it has no value on the axis.
std::optional<double> comparison_level(const BlockDesign& design, const results::AnswerRow& answer);

// Of thresholds, whose means are of decadic logarithms.
double from_log(double log);

// One answer more at this level. Levels from low to high.
void count_at(std::vector<Level>& levels, double level, bool is_success);

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

// Parametric bootstrap draws of a deviance test.
inline constexpr int draws_of_fit = 200;

// A mark for each level, its area by the level's share of the most trials at one.
std::vector<ChartPoint> level_points(const std::vector<Level>& levels);
// psi across the chart's range of x, as far as the shape allows.
std::vector<ChartPoint> curve_points(const Chart& chart, core::PsychometricShape shape,
                                     const PsychometricCurve& curve);
}  // namespace tapstudy::analysis
