#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "protocols/reader/read_sections.hpp"
#include "protocols/schedule/ordering.hpp"
#include "protocols/tasks/shared_keys.hpp"
#include "protocols/tasks/task.hpp"
#include "protocols/tasks/task_parts.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
namespace {
constexpr double largest_magnitude_value = 1e15;

std::optional<ValuesOnAxis> read_values(MapReader& reader, const Protocol& protocol,
                                        const Block& block) {
  if (!reader.has("values")) {
    reader.refuse("axis", "has values only with `values`");
    return std::nullopt;
  }
  const std::vector<std::string> axes =
      block.stimuli.empty() ? std::vector<std::string>{} : axes_of(protocol, block.stimuli.front());
  const std::string axis = read_axis(reader, protocol, block, axes);
  const std::vector<double> asked =
      reader.number_list({"values",
                          "magnitude only: on the axis, in increasing order; every stimulus is "
                          "presented at each; unset: the stimuli as they are"},
                         {-largest_magnitude_value, largest_magnitude_value});
  if (axes.empty()) {
    reader.reject("stimuli", "values are of stimuli that have `vary`");
  }
  if (std::ranges::find(axes, axis) == axes.end() || asked.empty()) {
    return std::nullopt;
  }
  return ValuesOnAxis{axis, presented_on_axis(reader, "values", protocol, block, {axis, asked})};
}

// How strong (hard, rough ...) is it, as a number? (Stevens 1957) With a modulus A, which has a
// number, B is judged; without one participants choose their own unit.
class Magnitude final : public PreferenceTask {
 public:
  std::string_view name() const override { return "magnitude"; }
  std::string_view statistic(const Block& /*block*/) const override { return "magnitudes"; }
  std::optional<Claim> claim() const override { return std::nullopt; }
  bool has_chance_level() const override { return false; }
  bool needs_reference() const override { return false; }
  bool uses_order() const override { return true; }
  bool can_present_real_plates() const override { return false; }
  std::string_view success() const override { return {}; }

  void read(MapReader& reader, const Protocol& protocol, Block& block) const override {
    block.on_axis = read_values(reader, protocol, block);
    reader.map({"modulus",
                "magnitude only: a stimulus whose number is given; unset: participants choose "
                "their own unit"},
               MapReader::Presence::optional, [&](MapReader& inner) {
                 block.modulus =
                     Modulus{inner.word({"stimulus", "presented as A in every trial; B is judged"},
                                        "stimulus", stimulus_names(protocol)),
                             inner.number({"number", "what participants are told that A is"},
                                          Range::positive(1e6))};
               });
  }
  std::vector<PlannedTrial> trials(const Block& block, const Draw& draw) const override {
    std::vector<PlannedTrial> all = ordered_trials(*this, block, draw);
    for (PlannedTrial& trial : all) {
      if (block.modulus) {
        trial.alternatives.front().is_comparison = true;
        trial.alternatives.insert(trial.alternatives.begin(), {block.modulus->stimulus});
      }
    }
    return all;
  }
  std::size_t trials_per_repetition(const Block& block) const override { return conditions(block); }
  Answers answers(const Block& block, const Protocol& /*protocol*/) const override {
    Answers numbers{AnswerKind::number};
    numbers.judged = block.modulus ? 1 : 0;
    if (block.modulus) {
      numbers.modulus = block.modulus->number;
    }
    return numbers;
  }
  std::vector<std::string> alternative_labels(const PlannedTrial& trial) const override {
    return trial.alternatives.size() > 1 ? blind_labels(trial) : std::vector<std::string>{};
  }
  std::vector<Remembered> remembered(const Block& /*block*/,
                                     const Simulation& /*simulation*/) const override {
    return {};
  }
  int visits(const Block& block, const SimulatedTapSettings& taps) const override {
    return block.modulus ? 2 * taps.visits : 1;
  }
  // A power of the felt amplitude: of vibration at 250 Hz the exponent is 0.6 (Stevens 1968, 1975).
  std::string simulated_answer(const Block& block, const Simulation& simulation,
                               SimulatedTouch& touch) const override {
    constexpr double exponent = 0.6;
    constexpr double own_unit = 1.0;
    constexpr double db_per_factor_10 = 20.0;
    double level_db = 0.0;
    if (block.modulus) {
      visit_all(2, simulation, touch);
      level_db = touch.level_db(1) - touch.level_db(0);
    } else {
      touch.visit(0);
      level_db = touch.level_db(0);
    }
    const double number = (block.modulus ? block.modulus->number : own_unit) *
                          std::pow(10.0, exponent * level_db / db_per_factor_10);
    return fmt::format("{}", std::stod(fmt::format("{:.3g}", number)));
  }
};
}  // namespace

const Task& magnitude() {
  static const Magnitude task;
  return task;
}
}  // namespace tapstudy::protocols
