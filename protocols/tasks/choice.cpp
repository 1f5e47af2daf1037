#include "protocols/protocol.hpp"
#include "protocols/tasks/task.hpp"
#include "protocols/tasks/whole_set_task.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
namespace {
class Choice final : public WholeSetTask {
 public:
  std::string_view name() const override { return "choice"; }
  std::string_view statistic(const Block& /*block*/) const override { return "choices"; }
  std::optional<Claim> claim() const override { return Claim::chosen_above_chance; }
  std::string_view success() const override { return "choose the expected one"; }

  void read(MapReader& reader, const Protocol& /*protocol*/, Block& block) const override {
    block.vote =
        reader.one_of<Vote>({"vote",
                             "choice only: which of a participant's repeated choices counts; "
                             "majority: the most frequent, of equals the earliest"},
                            {{"majority", Vote::majority}, {"first", Vote::first}}, "majority");
    reader.check_count("stimuli", block.stimuli, 2, max_stimuli,
                       "a choice needs at least two stimuli to choose from");
  }

  Answers answers(const Block& block, const Protocol& /*protocol*/) const override {
    return one_of(blind_options(block.stimuli.size()));
  }
  std::string response(const PlannedTrial& trial, const Block& /*block*/,
                       const std::string& answer) const override {
    return labelled(trial, answer).stimulus;
  }

  std::string simulated_answer(const Block& block, const Simulation& simulation,
                               SimulatedTouch& touch) const override {
    visit_all(block.stimuli.size(), simulation, touch);
    return blind_label(touch.most_similar_alternative(simulation.observer.reference));
  }
};
}  // namespace

const Task& choice() {
  static const Choice task;
  return task;
}
}  // namespace tapstudy::protocols
