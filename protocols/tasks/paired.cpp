#include <algorithm>
#include <array>

#include "core/text/plain_text.hpp"
#include "protocols/tasks/task.hpp"
#include "protocols/tasks/task_parts.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
namespace {
constexpr const char* tie = "tie";

// Which of the two, or neither? All pairs of the stimuli, each in either order equally often.
class Paired final : public PreferenceTask {
 public:
  std::string_view name() const override { return "paired"; }
  std::string_view statistic(const Block& /*block*/) const override { return "paired"; }
  std::optional<Claim> claim() const override { return Claim::chosen_above_chance; }
  bool uses_order() const override { return false; }
  bool can_present_real_plates() const override { return false; }
  std::string_view success() const override { return "prefer the expected one"; }
  // Ties are left out of tests.
  double chance_level(const Block& /*block*/, const Protocol& /*protocol*/) const override {
    return 0.5;
  }

  void read(MapReader& reader, const Protocol& /*protocol*/, Block& block) const override {
    reader.check_count("stimuli", block.stimuli, 2, max_stimuli, "pairs take at least two stimuli");
    block.tie = reader.translated({"tie",
                                   "paired only: a third answer, that there is no difference, and "
                                   "its label; stored as `tie`; unset: one of the two is chosen"},
                                  "");
    reader.is_in_data("tie");
    constexpr std::array switches{"true", "false", "yes", "no", "on", "off"};
    if (std::ranges::find(switches, core::lower_case(block.tie)) != switches.end()) {
      reader.reject("tie",
                    "is the label of the third answer, as 'no difference' (leave the key out "
                    "for none)");
    }
    if (!block.tie.empty() && std::ranges::find(block.stimuli, tie) != block.stimuli.end()) {
      reader.reject("tie", "is how this answer is stored: no stimulus can be called so");
    }
  }
  // A repetition presents each pair in both orders.
  std::vector<PlannedTrial> trials(const Block& block, const Draw& draw) const override {
    core::Rng rng{
        core::derived_seed(draw.participant_seed, core::Purpose::labels, draw.block_index)};
    return shuffled_repetitions(block, rng, [&](int repetition) {
      std::vector<PlannedTrial> part;
      for (const auto& [first, second] : pairs_of(block.stimuli.size())) {
        const Alternative one{block.stimuli[first]};
        const Alternative other{block.stimuli[second]};
        part.push_back({0, block.name, this, block.is_practice, repetition, {one, other}});
        part.push_back({0, block.name, this, block.is_practice, repetition, {other, one}});
      }
      return part;
    });
  }
  std::size_t trials_per_repetition(const Block& block) const override {
    return 2 * pairs_of(block.stimuli.size()).size();
  }
  Answers answers(const Block& block, const Protocol& /*protocol*/) const override {
    std::vector<Option> options = blind_options(2);
    if (!block.tie.empty()) {
      options.push_back({tie, block.tie});
    }
    return one_of(std::move(options));
  }
  std::string response(const PlannedTrial& trial, const Block& /*block*/,
                       const std::string& answer) const override {
    return answer == tie ? answer : labelled(trial, answer).stimulus;
  }
  std::vector<std::string> alternative_labels(const PlannedTrial& trial) const override {
    return blind_labels(trial);
  }
  int visits(const Block& /*block*/, const SimulatedTapSettings& taps) const override {
    return 2 * taps.visits;
  }
  // No difference if they are no further apart than two of the same are in half of the cases.
  std::string simulated_answer(const Block& block, const Simulation& simulation,
                               SimulatedTouch& touch) const override {
    constexpr double share_of_same = 0.5;
    visit_all(2, simulation, touch);
    if (!block.tie.empty() && !touch.are_different(simulation.observer.reference, share_of_same)) {
      return tie;
    }
    return blind_label(touch.most_similar_alternative(simulation.observer.reference));
  }
};
}  // namespace

const Task& paired() {
  static const Paired task;
  return task;
}
}  // namespace tapstudy::protocols
