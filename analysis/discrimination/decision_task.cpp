#include "analysis/discrimination/decision_task.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
namespace tapstudy::analysis {
std::optional<DecisionTask> decision_task(const BlockDesign& design) {
  if (design.decision_model.empty()) {
    return std::nullopt;
  }
  const DecisionModelRow* const row = find_decision_model(design.decision_model);
  if (row == nullptr) {
    throw core::InvalidInput{fmt::format("block '{}': there is no decision model '{}'", design.name,
                                         design.decision_model)};
  }
  const DecisionTask task{row->model, static_cast<int>(std::lround(1.0 / design.guess_rate))};
  constexpr double tolerance = 1e-6;
  if (std::abs(chance(task) - design.guess_rate) > tolerance) {
    throw core::InvalidInput{fmt::format("block '{}': {} has no guess rate of {}", design.name,
                                         row->name, design.guess_rate)};
  }
  return task;
}
}  // namespace tapstudy::analysis
