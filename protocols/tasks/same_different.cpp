#include "protocols/tasks/discrimination_task.hpp"
#include "protocols/tasks/shared_keys.hpp"
#include "protocols/tasks/task.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
namespace {
constexpr const char* same = "same";
constexpr const char* different = "different";
constexpr const char* standard_key = "the standard";

bool are_different(const PlannedTrial& trial) {
  return trial.alternatives[0].is_comparison != trial.alternatives[1].is_comparison;
}

// Are the two the same? Half of the trials present the same twice.
class SameDifferent final : public DiscriminationTask {
 public:
  std::string_view name() const override { return "same_different"; }
  // Where stimuli change from trial to trial, participants can only compare the two (Macmillan &
  // Creelman 2005, ch. 9): d' of such a differencing observer takes rates.
  std::string_view decision_model(const Block& block) const override {
    return block.stimuli.size() > 2 || block.comparison ? ""
                                                        : "same_different_independent_observation";
  }
  bool has_own_guess_rate() const override { return true; }
  Answers answers(const Block& block, const Protocol& /*protocol*/) const override {
    const auto label = [&](const char* response) {
      const auto found = block.response_labels.find(response);
      return found == block.response_labels.end() ? std::string{response} : found->second;
    };
    return one_of({{same, label(same)}, {different, label(different)}});
  }
  void read(MapReader& reader, const Protocol& protocol, Block& block) const override {
    DiscriminationTask::read(reader, protocol, block);
    read_response_labels(reader, {same, different}, block);
  }
  std::optional<bool> is_correct(const PlannedTrial& trial, const Block& /*block*/,
                                 const std::string& response) const override {
    return are_different(trial) == (response == different);
  }
  // "different" is a yes; it says nothing of the level where there was none.
  std::optional<std::size_t> outcome(const PlannedTrial& trial, const Block& block,
                                     const std::string& response) const override {
    return are_different(trial) ? DiscriminationTask::outcome(trial, block, response)
                                : std::nullopt;
  }
  // How much two of the same differ is known from practice.
  std::vector<Remembered> remembered(const Block& block,
                                     const Simulation& /*simulation*/) const override {
    AxisValues values;
    if (block.comparison) {
      values[block.comparison->axis] = block.comparison->standard;
    }
    return {{block.name + standard_key, block.stimuli.front(), values, false}};
  }
  // Different if they are further apart than two of the same are in five of six cases.
  std::string simulated_answer(const Block& block, const Simulation& simulation,
                               SimulatedTouch& touch) const override {
    constexpr double share_of_same = 5.0 / 6.0;
    visit_all(2, simulation, touch);
    return touch.are_different(block.name + standard_key, share_of_same) ? different : same;
  }

 protected:
  std::vector<Layout> layouts(const Block& /*block*/) const override {
    return {{false, false}, {false, true}, {true, true}, {true, false}};
  }
  int empty_trials_per_observation() const override { return 1; }
};
}  // namespace

const Task& same_different() {
  static const SameDifferent task;
  return task;
}
}  // namespace tapstudy::protocols
