#include <algorithm>

#include "protocols/tasks/discrimination_task.hpp"
#include "protocols/tasks/shared_keys.hpp"
#include "protocols/tasks/task.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
namespace {
constexpr const char* least_key = "the least";
constexpr const char* greatest_key = "the greatest";

// m-alternative forced choice: one alternative differs from the others, which? Or, where the
// standard is asked for, which of two is the standard? Of fixed stimuli, which are listed from the
// least to the greatest, the later one of each pair is right.
class ComparisonTask final : public DiscriminationTask {
 public:
  std::string_view name() const override { return "comparison"; }
  std::string_view statistic(const Block& block) const override {
    return is_on_either_side(block) ? "equality" : DiscriminationTask::statistic(block);
  }
  std::string_view decision_model(const Block& /*block*/) const override { return "forced_choice"; }

  void read(MapReader& reader, const Protocol& protocol, Block& block) const override {
    DiscriminationTask::read(reader, protocol, block);
    block.alternatives = read_alternatives(reader, 2, 8, 2);
    const bool is_standard_right =
        reader.one_of<bool>({"right", "comparison with procedures only: which of two is asked for"},
                            {{"comparison", false}, {"standard", true}}, "comparison");
    if (block.comparison) {
      block.comparison->is_standard_right = is_standard_right;
    } else if (is_standard_right) {
      reader.reject("right", "the standard only with procedures; list the stimuli the other way");
    }
    if (is_standard_right && block.alternatives > 2) {
      reader.reject("right", "the standard is one of two alternatives only");
    }
    if (is_on_either_side(block) && block.alternatives > 2) {
      reader.reject("alternatives", "are two where comparisons lie on either side of the standard");
    }
  }
  Answers answers(const Block& block, const Protocol& /*protocol*/) const override {
    return one_of(blind_options(static_cast<std::size_t>(block.alternatives)));
  }
  // Of a comparison that equals its standard neither answer is right.
  std::optional<bool> is_correct(const PlannedTrial& trial, const Block& block,
                                 const std::string& response) const override {
    const bool is_judged_greater = judged_greater(trial, block, response);
    if (!is_on_either_side(block)) {
      return is_judged_greater;
    }
    const double level = level_of_comparison(trial, *block.comparison);
    return level == 0.0 ? std::nullopt : std::optional{is_judged_greater == (level > 0.0)};
  }
  // On either side procedures follow how often the comparison is judged greater, from 0 to 1.
  std::optional<std::size_t> outcome(const PlannedTrial& trial, const Block& block,
                                     const std::string& response) const override {
    return judged_greater(trial, block, response) ? 1 : 0;
  }

  // Which way to look for is known from practice.
  std::vector<Remembered> remembered(const Block& block,
                                     const Simulation& /*simulation*/) const override {
    if (!block.comparison) {
      return {{block.name + least_key, block.stimuli.front(), {}, false},
              {block.name + greatest_key, block.stimuli.back(), {}, false}};
    }
    const Comparison& comparison = *block.comparison;
    const auto [low, high] = comparison.tracks.front()->ranges().front();
    const double least = is_on_either_side(block) ? comparison.value_at(low) : comparison.standard;
    const std::string& family = block.stimuli.front();
    return {
        {block.name + least_key, family, {{comparison.axis, least}}, false},
        {block.name + greatest_key, family, {{comparison.axis, comparison.value_at(high)}}, false}};
  }
  std::string simulated_answer(const Block& block, const Simulation& simulation,
                               SimulatedTouch& touch) const override {
    const auto alternatives = static_cast<std::size_t>(block.alternatives);
    visit_all(alternatives, simulation, touch);
    std::vector<double> positions;
    for (std::size_t i = 0; i < alternatives; ++i) {
      positions.push_back(touch.position(i, block.name + least_key, block.name + greatest_key));
    }
    const auto picked = is_least_right(block) ? std::ranges::min_element(positions)
                                              : std::ranges::max_element(positions);
    return blind_label(static_cast<std::size_t>(picked - positions.begin()));
  }

 protected:
  Sides sides() const override { return Sides::one_or_both; }
  std::vector<Layout> layouts(const Block& block) const override {
    const auto alternatives = static_cast<std::size_t>(block.alternatives);
    std::vector<Layout> ways(alternatives, Layout(alternatives, false));
    for (std::size_t place = 0; place < alternatives; ++place) {
      ways[place][place] = true;
    }
    return ways;
  }

 private:
  static bool is_on_either_side(const Block& block) {
    return block.comparison && block.comparison->side == Side::either;
  }
  static bool is_least_right(const Block& block) {
    return block.comparison && block.comparison->is_standard_right;
  }
  // On one side: answered right.
  static bool judged_greater(const PlannedTrial& trial, const Block& block,
                             const std::string& response) {
    return labelled(trial, response).is_comparison != is_least_right(block);
  }
  static double level_of_comparison(const PlannedTrial& trial, const Comparison& comparison) {
    const auto varied = std::ranges::find_if(trial.alternatives, &Alternative::is_comparison);
    return comparison.level_of(varied->values.at(comparison.axis));
  }
};
}  // namespace

const Task& comparison() {
  static const ComparisonTask task;
  return task;
}
}  // namespace tapstudy::protocols
