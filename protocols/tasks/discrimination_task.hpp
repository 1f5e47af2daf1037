#pragma once
#include <optional>

#include "protocols/protocol.hpp"
#include "protocols/tasks/task_parts.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
// Of the standard a task's comparisons may lie on.
enum class Sides { one, one_or_both };
// The block's comparison and its procedures; problems go to the reader. nullopt: there can be none.
std::optional<Comparison> read_comparison(MapReader& reader, const Protocol& protocol,
                                          const Block& block, Sides sides);

// Alternatives under blind labels, each the standard or a comparison: the members of a family at
// the standard's value and at one that procedures choose, or two different stimuli of the block.
class DiscriminationTask : public Task {
 public:
  std::string_view statistic(const Block& block) const override {
    return block.comparison ? "psychometric" : "discrimination";
  }
  std::optional<Claim> claim() const override { return Claim::accuracy_above_chance; }
  bool needs_reference() const override { return false; }
  bool has_correct_answer() const override { return true; }
  bool uses_order() const override { return false; }
  bool can_present_real_plates() const override { return false; }
  int counted_answers(const Block& block) const override {
    return block.repetitions * static_cast<int>(trials_per_repetition(block));
  }
  std::string_view success() const override { return "be right"; }

  void read(MapReader& reader, const Protocol& protocol, Block& block) const override;
  std::vector<PlannedTrial> trials(const Block& block, const Draw& draw) const override;
  std::size_t trials_per_repetition(const Block& block) const override;
  std::vector<std::string> alternative_labels(const PlannedTrial& trial) const override {
    return blind_labels(trial);
  }
  std::vector<Remembered> remembered(const Block& /*block*/,
                                     const Simulation& /*simulation*/) const override {
    return {};
  }
  int visits(const Block& block, const SimulatedTapSettings& taps) const override;

 protected:
  // Whether each alternative is the comparison, for each way to present a trial. All ways are
  // presented equally often, in every run of trials where procedures may end early.
  using Layout = std::vector<bool>;
  virtual std::vector<Layout> layouts(const Block& block) const = 0;
  virtual Sides sides() const { return Sides::one; }
  // Trials in which no comparison stands beside a standard, for each that has both.
  virtual int empty_trials_per_observation() const { return 0; }

 private:
  std::vector<PlannedTrial> of_family(const Block& block, core::Rng& rng) const;
  std::vector<PlannedTrial> of_pairs(const Block& block, core::Rng& rng) const;
};
}  // namespace tapstudy::protocols
