#pragma once
#include <string>
#include <vector>

#include "analysis/rank_tests/friedman.hpp"
#include "analysis/tables/cells.hpp"
namespace tapstudy::analysis {
// "participants": a row for each participant and stimulus, for programs. values: [participant]
// [stimulus].
ReportTable participant_values_table(const std::string& title, const Column& of,
                                     const std::vector<std::string>& participants,
                                     const std::vector<std::string>& stimuli,
                                     const RatingTable& values);
}  // namespace tapstudy::analysis
