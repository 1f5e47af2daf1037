#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "protocols/tasks/task.hpp"
#include "protocols/tasks/whole_set_task.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
namespace {
constexpr std::size_t fewest = 3;  // of two, one is chosen
constexpr std::size_t most = 8;

std::string with_spaces(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

// All stimuli under blind labels, felt as often as wanted; the answer is their order.
class Ranking final : public WholeSetTask {
 public:
  std::string_view name() const override { return "ranking"; }
  std::string_view statistic(const Block& /*block*/) const override { return "rankings"; }
  std::optional<Claim> claim() const override { return std::nullopt; }
  bool has_chance_level() const override { return false; }
  std::string_view success() const override { return {}; }

  void read(MapReader& reader, const Protocol& /*protocol*/, Block& block) const override {
    const std::size_t count = block.stimuli.size();
    reader.check_count(
        "stimuli", block.stimuli, fewest, most,
        fmt::format("a ranking is of {} to {} stimuli, not {}", fewest, most, count));
    if (!block.explore.must_visit_all) {
      reader.reject("explore", "visit_all cannot be false: a ranking is of stimuli that were felt");
    }
  }
  Answers answers(const Block& block, const Protocol& /*protocol*/) const override {
    return {AnswerKind::order, blind_options(block.stimuli.size())};
  }
  // The names of the stimuli, with a space between.
  std::string response(const PlannedTrial& trial, const Block& /*block*/,
                       const std::string& answer) const override {
    std::vector<std::string> stimuli;
    for (const std::string& label : names_in_order(answer)) {
      stimuli.push_back(labelled(trial, label).stimulus);
    }
    return with_spaces(stimuli);
  }
  // The one nearest to the reference first.
  std::string simulated_answer(const Block& block, const Simulation& simulation,
                               SimulatedTouch& touch) const override {
    visit_all(block.stimuli.size(), simulation, touch);
    std::vector<std::pair<double, std::string>> felt;
    for (std::size_t i = 0; i < block.stimuli.size(); ++i) {
      felt.emplace_back(touch.distance(i, simulation.observer.reference), blind_label(i));
    }
    std::ranges::sort(felt);
    std::vector<std::string> labels;
    std::ranges::transform(felt, std::back_inserter(labels),
                           &std::pair<double, std::string>::second);
    return with_spaces(labels);
  }
};
}  // namespace

const Task& ranking() {
  static const Ranking task;
  return task;
}
}  // namespace tapstudy::protocols
