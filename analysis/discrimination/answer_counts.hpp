#pragma once
#include <optional>
#include <vector>

#include "analysis/blocks/design.hpp"
#include "analysis/detection/decision_model.hpp"
#include "analysis/tables/cells.hpp"
#include "results/rows.hpp"
namespace tapstudy::analysis {
// The block's decision model with the alternatives that its guess rate stands for; unset if it has
// none. Throws InvalidInput where there is no such model, or it has no such guess rate.
std::optional<DecisionTask> decision_task(const BlockDesign& design);

// How often each participant gave each answer: one that is preferred whatever is presented is a
// bias. All are right equally often.
ReportTable answer_counts_table(const std::vector<results::AnswerRow>& answers);
}  // namespace tapstudy::analysis
