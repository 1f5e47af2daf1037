#pragma once
#include <string>
#include <vector>

#include "analysis/blocks/block_summary.hpp"
#include "analysis/rank_tests/friedman.hpp"
#include "analysis/tables/cells.hpp"
namespace tapstudy::analysis {
// "participants": a row for each participant and stimulus, for programs. values: [participant]
// [stimulus].
ReportTable participant_values_table(const std::string& title, const Column& of,
                                     const std::vector<std::string>& participants,
                                     const std::vector<std::string>& stimuli,
                                     const RatingTable& values);
// "WHAT: STIMULUS", the mean of the participants' values with its t interval; of two participants
// or more. values: [participant][stimulus].
std::vector<MainResult> means_over_participants(const std::string& what,
                                                const std::vector<std::string>& stimuli,
                                                const std::vector<std::vector<double>>& values);
}  // namespace tapstudy::analysis
