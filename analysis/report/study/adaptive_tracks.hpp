#pragma once
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/document/sections.hpp"
#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// Of a parameter's posterior.
struct ParameterEstimate {
  std::string name;
  double mean{};
  Interval range;  // 95 %, equal tails
  double standard_deviation{};
  bool is_at_end{};  // of the grid: the most probable value, so that the posterior is cut off
};

// What a procedure that chose the levels knew after a participant's last answer.
struct TrackResult {
  std::string participant_id;
  std::string block;
  int track{};           // of the block, from 1
  CitingText procedure;  // with its source
  std::size_t trials{};
  bool is_finished{};
  bool is_signed{};                             // its levels lie on both sides of the standard
  std::optional<double> estimate;               // of the level; unset: it makes none, or not yet
  std::optional<double> settles_at{};           // proportion; of a staircase
  std::size_t reversals{};                      // likewise
  std::size_t trials_at_limit{};                // likewise
  std::vector<ParameterEstimate> parameters{};  // that are estimated
};

// Tables procedure_tracks, a row a track; procedure_means, over participants, whose own tracks of
// one procedure are averaged before (of levels that are not signed, geometric means); and
// procedure_posteriors, a row a parameter.
ReportSection procedures_section(const std::vector<TrackResult>& tracks);
}  // namespace tapstudy::analysis
