#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "protocols/axes/axis_range.hpp"
#include "protocols/axes/presented_stimulus.hpp"
#include "protocols/reader/read_sections.hpp"
#include "protocols/tasks/shared_keys.hpp"
#include "protocols/tasks/task.hpp"
#include "protocols/tasks/task_parts.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
namespace {
constexpr double largest_adjusted_value = 1e15;

// The values that the key `settings` asks for.
std::vector<double> read_settings(MapReader& reader, Spacing& spacing) {
  std::vector<double> values;
  reader.map({"settings",
              "adjustment only, required there: the values that participants can choose; runs "
              "start at random ones, half below and half above the standard"},
             MapReader::Presence::required, [&](MapReader& inner) {
               const auto read = read_spaced(inner, {"from", "to"},
                                             {-largest_adjusted_value, largest_adjusted_value},
                                             static_cast<int>(max_settings));
               if (read) {
                 values = read->values;
                 spacing = read->spacing;
               }
             });
  return values;
}

// The stimulus's own value where none is given. Nothing is checked where the settings were refused.
void read_standard(MapReader& reader, const Protocol& protocol, const Block& block,
                   Adjustment& adjustment) {
  const bool is_usable = !adjustment.values.empty();
  const auto presented = [&](const AxisValues& asked) {
    return presented_values(protocol, protocol.stimulus(block.stimuli.front()), asked)
        .at(adjustment.axis);
  };
  const double own = is_usable ? presented({}) : 0.0;
  const double standard =
      read_standard_value(reader, {-largest_adjusted_value, largest_adjusted_value}, own);
  if (!is_usable) {
    return;
  }
  const double low = adjustment.values.front();
  const double high = adjustment.values.back();
  try {
    adjustment.standard = presented({{adjustment.axis, standard}});
  } catch (const core::InvalidInput& error) {
    reader.reject("standard", error.what());
    return;
  }
  if (standard < low || standard > high) {
    reader.reject(
        reader.has("standard") ? "standard" : "settings",
        fmt::format("{} the standard, {:.6g}, is not within the settings, {:.6g} to {:.6g}",
                    reader.has("standard") ? "cannot be set:" : "do not include it:", standard, low,
                    high));
  }
}

void read_reference(MapReader& reader, const Protocol& protocol, const Block& block,
                    Adjustment& adjustment) {
  adjustment.reference = reader.word({"reference",
                                      "adjustment only: another stimulus is the standard; unset: "
                                      "the stimulus itself at `standard`"},
                                     "stimulus", stimulus_names(protocol));
  if (!block.stimuli.empty() && adjustment.reference == block.stimuli.front()) {
    reader.reject("reference", "is the stimulus that is adjusted: give its value as standard");
  }
  reader.refuse("standard", "is a value of the stimulus itself: not with a reference");
}

std::optional<Adjustment> read_adjustment(MapReader& reader, const Protocol& protocol,
                                          const Block& block) {
  const std::vector<std::string> axes = block.stimuli.size() == 1
                                            ? axes_of(protocol, block.stimuli.front())
                                            : std::vector<std::string>{};
  Adjustment adjustment;
  const std::vector<double> asked = read_settings(reader, adjustment.spacing);
  const char* const one_that_varies = "an adjustment moves one stimulus, which must have `vary`";
  reader.check_count("stimuli", block.stimuli, 0, 1, one_that_varies);
  if (reader.depends_on_others(axes.empty())) {
    for (const char* const key : {"axis", "standard", "reference"}) {
      reader.leave(key);
    }
    if (block.stimuli.size() != 1 || !is_vary_refused(protocol, block)) {
      reader.reject("stimuli", one_that_varies);
    }
    return std::nullopt;
  }
  adjustment.axis = read_axis(reader, protocol, block, axes);
  if (std::ranges::find(axes, adjustment.axis) != axes.end() && !asked.empty()) {
    adjustment.values =
        presented_on_axis(reader, "settings", protocol, block, {adjustment.axis, asked});
  }
  if (reader.has("reference")) {
    read_reference(reader, protocol, block, adjustment);
  } else {
    read_standard(reader, protocol, block, adjustment);
  }
  return adjustment.values.empty() ? std::nullopt : std::optional{adjustment};
}

// Of so many runs half start below and half above, each anywhere there; an odd one on either side.
std::vector<double> starts(const Adjustment& adjustment, int runs, core::Rng& rng) {
  std::vector<double> below;
  std::vector<double> above;
  for (const double value : adjustment.values) {
    if (value != adjustment.middle()) {
      (value < adjustment.middle() ? below : above).push_back(value);
    }
  }
  const bool is_odd_one_below = rng.below(2) == 0;
  std::vector<double> drawn;
  for (int run = 0; run < runs; ++run) {
    const bool is_wanted_below = (run % 2 == 0) == is_odd_one_below;
    const std::vector<double>& side =
        above.empty() || (is_wanted_below && !below.empty()) ? below : above;
    drawn.push_back(side[rng.below(static_cast<std::uint32_t>(side.size()))]);
  }
  rng.shuffle(drawn);
  return drawn;
}

// A feels like what? B is moved until it feels equal (method of adjustment, Fechner 1860; "cut and
// try" where the standard is another stimulus).
class AdjustmentTask final : public PreferenceTask {
 public:
  std::string_view name() const override { return "adjustment"; }
  std::string_view statistic(const Block& /*block*/) const override { return "adjustments"; }
  std::optional<Claim> claim() const override { return std::nullopt; }
  bool has_chance_level() const override { return false; }
  bool needs_reference() const override { return false; }
  bool uses_order() const override { return false; }
  bool can_present_real_plates() const override { return false; }
  std::string_view success() const override { return {}; }

  void read(MapReader& reader, const Protocol& protocol, Block& block) const override {
    block.adjustment = read_adjustment(reader, protocol, block);
    reader.check("correction", !block.allows_correction, R"({"const": false})",
                 "is of answers that participants can name, not of a setting");
  }
  std::vector<PlannedTrial> trials(const Block& block, const Draw& draw) const override {
    core::Rng rng{
        core::derived_seed(draw.participant_seed, core::Purpose::schedule, draw.block_index)};
    const Adjustment& of = *block.adjustment;
    const std::string& stimulus = block.stimuli.front();
    const Alternative standard =
        of.standard ? Alternative{stimulus, {{of.axis, *of.standard}}} : Alternative{of.reference};
    std::vector<PlannedTrial> all;
    for (const double start : starts(of, block.repetitions, rng)) {
      all.push_back({0,
                     block.name,
                     this,
                     block.is_practice,
                     static_cast<int>(all.size()) + 1,
                     {standard, {stimulus, {{of.axis, start}}, true}}});
    }
    return all;
  }
  std::size_t trials_per_repetition(const Block& /*block*/) const override { return 1; }

  std::optional<Settings> settings(const PlannedTrial& trial, const Block& block) const override {
    const Adjustment& of = *block.adjustment;
    Settings settings;
    for (const double value : of.values) {
      settings.values.push_back({{of.axis, value}});
    }
    const auto start = std::ranges::find(settings.values, trial.alternatives.back().values);
    settings.start = static_cast<std::size_t>(start - settings.values.begin());
    return settings;
  }
  Answers answers(const Block& block, const Protocol& /*protocol*/) const override {
    Answers answers{AnswerKind::setting};
    answers.judged = 1;
    answers.settings = block.adjustment ? block.adjustment->values.size() : 0;
    return answers;
  }
  std::string response(const PlannedTrial& /*trial*/, const Block& block,
                       const std::string& answer) const override {
    return fmt::format("{}", block.adjustment->values.at(std::stoul(answer) - 1));
  }
  std::vector<std::string> alternative_labels(const PlannedTrial& trial) const override {
    return blind_labels(trial);
  }
  std::vector<Remembered> remembered(const Block& /*block*/,
                                     const Simulation& /*simulation*/) const override {
    return {};
  }
  // Both, then B after each move: about twice at each length of moves.
  int visits(const Block& block, const SimulatedTapSettings& taps) const override {
    int lengths = 0;
    for (int length = first_move(block); length > 0; length /= 2) {
      ++lengths;
    }
    return taps.visits * 2 * (1 + lengths);
  }

  // Moves on as long as B feels less different from A than ever before, else back and the other
  // way, by ever shorter moves, until none is felt to bring it nearer.
  std::string simulated_answer(const Block& block, const Simulation& simulation,
                               SimulatedTouch& touch) const override {
    visit_all(2, simulation, touch);
    double least = felt_difference(block, touch);
    int way = touch.rng().below(2) == 0 ? 1 : -1;
    for (int length = first_move(block); length > 0; length /= 2) {
      int turns = 0;
      while (turns < 2) {
        if (is_nearer(way * length, block, simulation, touch, least)) {
          continue;
        }
        way = -way;
        ++turns;
      }
    }
    return fmt::format("{}", touch.setting() + 1);
  }

 private:
  static int first_move(const Block& block) {
    return static_cast<int>(block.adjustment->values.size() / 2);
  }

  // From another stimulus, which it cannot equal, in strength; from itself, in whatever is felt.
  static double felt_difference(const Block& block, SimulatedTouch& touch) {
    return block.adjustment->standard ? touch.distance(std::size_t{0}, std::size_t{1})
                                      : std::abs(touch.level_db(1) - touch.level_db(0));
  }

  // Where it is not nearer, it is moved back.
  static bool is_nearer(int move, const Block& block, const Simulation& simulation,
                        SimulatedTouch& touch, double& least) {
    if (!touch.adjust(move)) {
      return false;
    }
    for (int visit = 0; visit < simulation.taps.visits; ++visit) {
      touch.visit(1);
    }
    const double difference = felt_difference(block, touch);
    if (difference < least) {
      least = difference;
      return true;
    }
    touch.adjust(-move);
    return false;
  }
};
}  // namespace

const Task& adjustment() {
  static const AdjustmentTask task;
  return task;
}
}  // namespace tapstudy::protocols
