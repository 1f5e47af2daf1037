#include "protocols/tasks/discrimination_task.hpp"
#include "protocols/tasks/shipped_tasks.hpp"
namespace tapstudy::protocols {
namespace {
// A and B differ; X is one of them again: which? (Munson & Gardner 1950)
class Abx final : public DiscriminationTask {
 public:
  std::string_view name() const override { return "abx"; }
  std::string_view decision_model() const override { return "abx_differencing"; }
  Answers answers(const Block& /*block*/, const Protocol& /*protocol*/) const override {
    return one_of(blind_options(2));
  }
  std::vector<std::string> alternative_labels(const PlannedTrial& /*trial*/) const override {
    return {blind_label(0), blind_label(1), "X"};
  }
  std::optional<bool> is_correct(const PlannedTrial& trial, const Block& /*block*/,
                                 const std::string& response) const override {
    return labelled(trial, response).is_comparison == trial.alternatives.at(2).is_comparison;
  }
  std::string simulated_answer(const Block& /*block*/, const Simulation& simulation,
                               SimulatedTouch& touch) const override {
    visit_all(3, simulation, touch);
    const double from_a = touch.distance(std::size_t{0}, std::size_t{2});
    const double from_b = touch.distance(std::size_t{1}, std::size_t{2});
    return blind_label(from_a <= from_b ? 0 : 1);
  }

 protected:
  std::vector<Layout> layouts(const Block& /*block*/) const override {
    return {{false, true, false}, {false, true, true}, {true, false, false}, {true, false, true}};
  }
};
}  // namespace

const Task& abx() {
  static const Abx task;
  return task;
}
}  // namespace tapstudy::protocols
