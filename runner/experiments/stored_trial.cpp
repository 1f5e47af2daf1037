#include "runner/experiments/stored_trial.hpp"
namespace tapstudy::runner {
protocols::PlannedTrial stored_trial(const results::TrialRow& row,
                                     const std::vector<results::AlternativeRow>& alternatives,
                                     const protocols::Block& block) {
  protocols::PlannedTrial trial;
  trial.number = row.number;
  trial.block = row.block;
  trial.task = block.task;
  trial.is_practice = row.is_practice;
  trial.repetition = row.repetition;
  trial.is_catch = row.is_catch;
  for (const results::AlternativeRow& alternative : alternatives) {
    trial.alternatives.push_back(
        {alternative.stimulus, alternative.axis_values, alternative.is_comparison});
  }
  return trial;
}
}  // namespace tapstudy::runner
