#pragma once
#include "protocols/tasks/discrimination_task.hpp"
namespace tapstudy::protocols {
// Alternatives under blind labels and one of them again, the sample X, as the last: which of them?
// Alternatives whose is_comparison is that of the sample are the same as it.
class SampleTask : public DiscriminationTask {
 public:
  Answers answers(const Block& block, const Protocol& protocol) const override;
  std::vector<std::string> alternative_labels(const PlannedTrial& trial) const override;
  std::optional<bool> is_correct(const PlannedTrial& trial, const Block& block,
                                 const std::string& response) const override;
  // The one at the smallest distance from the sample.
  std::string simulated_answer(const Block& block, const Simulation& simulation,
                               SimulatedTouch& touch) const override;

 protected:
  // Without the sample.
  virtual std::size_t alternatives(const Block& block) const = 0;
};
}  // namespace tapstudy::protocols
