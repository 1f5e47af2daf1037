#pragma once
#include "protocols/tasks/task_parts.hpp"
namespace tapstudy::protocols {
// No answer is right: participants say what they prefer, or how much. Simulated ones compare with
// the stimulus that the protocol takes for reality.
class PreferenceTask : public Task {
 public:
  bool needs_reference() const override { return true; }
  bool has_correct_answer() const override { return false; }
  int counted_answers(const Block& /*block*/) const override { return 1; }  // a vote
  std::optional<bool> is_correct(const PlannedTrial& /*trial*/, const Block& /*block*/,
                                 const std::string& /*response*/) const override {
    return std::nullopt;
  }
  std::vector<Remembered> remembered(const Block& /*block*/,
                                     const Simulation& simulation) const override {
    return {{simulation.observer.reference, simulation.observer.reference}};
  }
};
}  // namespace tapstudy::protocols
