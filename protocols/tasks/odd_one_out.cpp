#include <algorithm>

#include "protocols/tasks/discrimination_task.hpp"
#include "protocols/tasks/shared_keys.hpp"
#include "protocols/tasks/task.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
namespace {
// One of three (a triangle test) or of four differs from the others: which?
class OddOneOut final : public DiscriminationTask {
 public:
  std::string_view name() const override { return "odd_one_out"; }
  std::string_view decision_model(const Block& /*block*/) const override { return "oddity"; }
  void read(MapReader& reader, const Protocol& protocol, Block& block) const override {
    block.alternatives = read_alternatives(reader, 3, 4, 3);
    DiscriminationTask::read(reader, protocol, block);
  }
  Answers answers(const Block& block, const Protocol& /*protocol*/) const override {
    return one_of(blind_options(static_cast<std::size_t>(block.alternatives)));
  }
  std::optional<bool> is_correct(const PlannedTrial& trial, const Block& /*block*/,
                                 const std::string& response) const override {
    const auto comparisons = std::ranges::count_if(trial.alternatives, &Alternative::is_comparison);
    const bool is_comparison_odd = comparisons == 1;
    return labelled(trial, response).is_comparison == is_comparison_odd;
  }
  // The one that is furthest from all others together.
  std::string simulated_answer(const Block& block, const Simulation& simulation,
                               SimulatedTouch& touch) const override {
    const auto alternatives = static_cast<std::size_t>(block.alternatives);
    visit_all(alternatives, simulation, touch);
    std::vector<double> sums(alternatives, 0.0);
    for (const auto& [first, second] : pairs_of(alternatives)) {
      const double distance = touch.distance(first, second);
      sums[first] += distance;
      sums[second] += distance;
    }
    return blind_label(static_cast<std::size_t>(std::ranges::max_element(sums) - sums.begin()));
  }

 protected:
  std::vector<Layout> layouts(const Block& block) const override {
    const auto alternatives = static_cast<std::size_t>(block.alternatives);
    std::vector<Layout> ways;
    for (const bool is_comparison_odd : {true, false}) {
      for (std::size_t odd = 0; odd < alternatives; ++odd) {
        Layout way(alternatives, !is_comparison_odd);
        way[odd] = is_comparison_odd;
        ways.push_back(way);
      }
    }
    return ways;
  }
};
}  // namespace

const Task& odd_one_out() {
  static const OddOneOut task;
  return task;
}
}  // namespace tapstudy::protocols
