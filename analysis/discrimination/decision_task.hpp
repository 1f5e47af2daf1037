#pragma once
#include <optional>

#include "analysis/blocks/design.hpp"
#include "analysis/detection/decision_model.hpp"
namespace tapstudy::analysis {
// The block's decision model with the alternatives that its guess rate stands for; unset if it has
// none. Throws InvalidInput where there is no such model, or it has no such guess rate.
std::optional<DecisionTask> decision_task(const BlockDesign& design);
}  // namespace tapstudy::analysis
