#include "runner/session/engine/alternative_rows.hpp"

#include <algorithm>
#include <string>
namespace tapstudy::runner {
std::vector<results::AlternativeRow> alternative_rows(const protocols::PlannedTrial& trial,
                                                      const protocols::Block& block) {
  const std::vector<std::string> labels = trial.task->alternative_labels(trial);
  const std::vector<protocols::Alternative> alternatives = rendered(trial, block);
  std::vector<results::AlternativeRow> rows;
  for (std::size_t i = 0; i < alternatives.size(); ++i) {
    const std::string label =
        labels.empty() ? std::string{} : labels[std::min(i, labels.size() - 1)];
    rows.push_back({static_cast<int>(i), label, alternatives[i].stimulus, alternatives[i].values,
                    alternatives[i].is_comparison});
  }
  return rows;
}
}  // namespace tapstudy::runner
