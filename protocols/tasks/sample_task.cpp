#include "protocols/tasks/sample_task.hpp"

#include <algorithm>
namespace tapstudy::protocols {
Answers SampleTask::answers(const Block& block, const Protocol& /*protocol*/) const {
  return one_of(blind_options(alternatives(block)));
}

std::vector<std::string> SampleTask::alternative_labels(const PlannedTrial& trial) const {
  std::vector<std::string> labels = blind_labels(trial);
  labels.pop_back();
  labels.emplace_back("X");
  return labels;
}

std::optional<bool> SampleTask::is_correct(const PlannedTrial& trial, const Block& /*block*/,
                                           const std::string& response) const {
  return labelled(trial, response).is_comparison == trial.alternatives.back().is_comparison;
}

std::string SampleTask::simulated_answer(const Block& block, const Simulation& simulation,
                                         SimulatedTouch& touch) const {
  const std::size_t sample = alternatives(block);
  visit_all(sample + 1, simulation, touch);
  std::vector<double> distances;
  for (std::size_t i = 0; i < sample; ++i) {
    distances.push_back(touch.distance(i, sample));
  }
  const auto nearest = std::ranges::min_element(distances);
  return blind_label(static_cast<std::size_t>(nearest - distances.begin()));
}
}  // namespace tapstudy::protocols
