#pragma once
#include <vector>

#include "analysis/tables/cells.hpp"
#include "results/rows.hpp"
namespace tapstudy::analysis {
// How often each participant gave each answer: one that is preferred whatever is presented is a
// bias. All are right equally often.
ReportTable answer_counts_table(const std::vector<results::AnswerRow>& answers);
}  // namespace tapstudy::analysis
