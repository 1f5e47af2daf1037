#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "protocols/schedule/ordering.hpp"
#include "protocols/tasks/task.hpp"
#include "protocols/tasks/task_parts.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
namespace {
// How real (hard, pleasant ...) is it, from 1 to so many steps, or on a line?
class Rating final : public PreferenceTask {
 public:
  std::string_view name() const override { return "rating"; }
  std::string_view statistic(const Block& /*block*/) const override { return "ratings"; }
  std::optional<Claim> claim() const override { return Claim::rated_highest; }
  bool has_chance_level() const override { return false; }
  bool uses_order() const override { return true; }
  bool can_present_real_plates() const override { return true; }
  std::string_view success() const override { return "be the highest"; }

  void read(MapReader& reader, const Protocol& /*protocol*/, Block& block) const override {
    RatingScale scale;
    scale.kind = reader.one_of<ScaleKind>(
        {"scale", "rating only: steps from 1, or a mark on a line, stored as 0 to 1"},
        {{"likert", ScaleKind::likert}, {"visual_analogue", ScaleKind::visual_analogue}}, "likert");
    if (scale.kind == ScaleKind::likert) {
      scale.steps =
          reader.integer({"steps", "rating only, with likert: from 1 to this"}, 2, 11, scale.steps);
    }
    scale.low = reader.translated({"low", "what the lowest means; unset: not of this task"});
    scale.high = reader.translated({"high", "what the highest means; unset: not of this task"});
    block.rating = scale;
  }
  std::vector<PlannedTrial> trials(const Block& block, const Draw& draw) const override {
    return ordered_trials(*this, block, draw);
  }
  std::size_t trials_per_repetition(const Block& block) const override {
    return block.stimuli.size();
  }
  Answers answers(const Block& block, const Protocol& /*protocol*/) const override {
    if (block.rating->kind == ScaleKind::visual_analogue) {
      Answers line{AnswerKind::line};
      line.ends = {block.rating->low, block.rating->high};
      return line;
    }
    std::vector<Option> all;
    for (int step = 1; step <= block.rating->steps; ++step) {
      const std::string number = std::to_string(step);
      all.push_back({number, number});
    }
    all.front().label += " " + block.rating->low;
    all.back().label += " " + block.rating->high;
    Answers steps = one_of(std::move(all));
    steps.ends = {block.rating->low, block.rating->high};
    return steps;
  }
  std::vector<std::string> alternative_labels(const PlannedTrial& /*trial*/) const override {
    return {};
  }
  int visits(const Block& /*block*/, const SimulatedTapSettings& /*taps*/) const override {
    return 1;
  }
  // The nearer to the reference, the higher: a mean square of 1, its own noise, is the top.
  std::string simulated_answer(const Block& block, const Simulation& simulation,
                               SimulatedTouch& touch) const override {
    touch.visit(0);
    const double excess =
        std::max(0.0, touch.distance(std::size_t{0}, simulation.observer.reference) - 1.0);
    const double nearness = std::exp(-excess);
    if (block.rating->kind == ScaleKind::visual_analogue) {
      constexpr double marks = 100.0;  // as fine as a page's line
      return fmt::format("{}", std::round(marks * nearness) / marks);
    }
    return std::to_string(1 + std::lround((block.rating->steps - 1) * nearness));
  }
};
}  // namespace

const Task& rating() {
  static const Rating task;
  return task;
}
}  // namespace tapstudy::protocols
