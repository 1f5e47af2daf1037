#pragma once
#include "protocols/tasks/task_parts.hpp"
namespace tapstudy::protocols {
// All of the block's stimuli are the alternatives of each trial, under blind labels: one trial a
// repetition. Which of them has which label is drawn anew for each: a label has no history.
class WholeSetTask : public PreferenceTask {
 public:
  bool uses_order() const override { return false; }
  bool can_present_real_plates() const override { return false; }
  std::vector<PlannedTrial> trials(const Block& block, const Draw& draw) const override;
  std::size_t trials_per_repetition(const Block& /*block*/) const override { return 1; }
  std::vector<std::string> alternative_labels(const PlannedTrial& trial) const override {
    return blind_labels(trial);
  }
  int visits(const Block& block, const SimulatedTapSettings& taps) const override {
    return taps.visits * static_cast<int>(block.stimuli.size());
  }
};
}  // namespace tapstudy::protocols
