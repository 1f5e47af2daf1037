// What a protocol says of a staircase.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "protocols/procedures/read_grid.hpp"
#include "protocols/procedures/shipped_procedures.hpp"
#include "protocols/procedures/staircase_track.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
namespace {
constexpr int max_staircase_trials = 1000;
constexpr int max_staircase_reversals = 500;
enum class StepKind { linear, db, factor };
enum class Rule { transformed, weighted };

class StaircaseStart final : public TrackSettings {
 public:
  explicit StaircaseStart(const StaircaseSettings& settings) : settings_{settings} {}
  std::size_t axes() const override { return 1; }
  std::size_t outcomes() const override { return 2; }
  std::size_t max_trials() const override { return settings_.max_trials; }
  bool may_end_early() const override { return settings_.max_reversals.has_value(); }
  std::vector<std::pair<double, double>> ranges() const override {
    return {{settings_.min, settings_.max}};
  }
  std::optional<double> settles_at() const override { return staircase_target(settings_); }
  bool is_harder_below() const override { return settings_.is_harder_below; }
  std::string words() const override {
    const std::string rule = settings_.easier_per_harder == 1.0
                                 ? fmt::format("a {} up, {} down staircase (Levitt 1971)",
                                               settings_.n_up, settings_.n_down)
                                 : "a weighted up-down staircase (Kaernbach 1991)";
    return fmt::format("{} that settles at {:.3g} correct", rule, staircase_target(settings_));
  }
  // Nothing in it is random.
  std::unique_ptr<Track> start(std::uint64_t /*seed*/) const override {
    return start_staircase(settings_);
  }

 private:
  StaircaseSettings settings_;
};

// In dB where the step is a factor.
double read_step(MapReader& reader, const std::string& key, StepKind kind,
                 std::optional<double> otherwise) {
  const double step = reader.number(key, Range::positive(largest_value), otherwise);
  if (reader.has(key) && kind == StepKind::factor && step <= 1.0) {
    reader.reject(key, "is not above 1, as a factor must be to move");
  }
  return step;
}

void read_steps(MapReader& reader, StaircaseSettings& settings) {
  const auto kind = reader.one_of<StepKind>(
      "steps", {{"linear", StepKind::linear}, {"db", StepKind::db}, {"factor", StepKind::factor}});
  settings.is_in_db = kind != StepKind::linear;
  settings.first_step = read_step(reader, "first_step", kind, {});
  settings.min_step = read_step(reader, "min_step", kind, settings.first_step);
  if (settings.min_step > settings.first_step) {
    reader.reject("min_step", "is above first_step");
  }
  if (kind == StepKind::factor) {
    settings.first_step = 20.0 * std::log10(settings.first_step);
    settings.min_step = 20.0 * std::log10(settings.min_step);
  }
}

void read_rule(MapReader& reader, StaircaseSettings& settings) {
  const auto rule = reader.one_of<Rule>(
      "rule", {{"transformed", Rule::transformed}, {"weighted", Rule::weighted}});
  const bool is_weighted = rule == Rule::weighted;
  for (const char* key : {"n_down", "n_up"}) {
    if (is_weighted && reader.has(key)) {
      reader.reject(key, "is for rule: transformed only");
    }
  }
  if (!is_weighted && reader.has("target")) {
    reader.reject("target", "is for rule: weighted only");
  }
  if (is_weighted) {
    const double target = reader.number("target", {0.05, 0.95});
    settings.easier_per_harder = target / (1.0 - target);
  } else {
    settings.n_down = reader.integer("n_down", 1, 10);
    settings.n_up = reader.integer("n_up", 1, 10, 1);
  }
}

void read_stop(MapReader& top, StaircaseSettings& settings) {
  top.map("stop", MapReader::Presence::required, [&](MapReader& reader) {
    if (!reader.has("reversals") && !reader.has("trials")) {
      reader.reject("has neither reversals nor trials");
    }
    if (reader.has("reversals")) {
      settings.max_reversals =
          static_cast<std::size_t>(reader.integer("reversals", 1, max_staircase_reversals));
    }
    settings.max_trials = static_cast<std::size_t>(
        reader.integer("trials", 1, max_staircase_trials, max_staircase_trials));
  });
  settings.estimate_reversals =
      static_cast<std::size_t>(top.integer("estimate_reversals", 2, max_staircase_reversals));
  if (settings.estimate_reversals % 2 != 0) {
    top.reject("estimate_reversals", "is odd: as many peaks as valleys are averaged");
  }
  // the first trial is no reversal
  const std::size_t attainable = settings.max_trials - 1;
  if (settings.estimate_reversals >
      std::min(attainable, settings.max_reversals.value_or(attainable))) {
    top.reject("estimate_reversals", "is more than there are before the staircase stops");
  }
}

bool read_limits(MapReader& reader, StaircaseSettings& settings) {
  const Range any{-largest_value, largest_value};
  settings.start = reader.number("start", any);
  settings.min = reader.number("min", any);
  settings.max = reader.number("max", any);
  if (settings.max <= settings.min) {
    reader.reject("max", "is not above min: the staircase cannot move");
    return false;
  }
  if (settings.start < settings.min || settings.start > settings.max) {
    reader.reject("start", "is not between min and max");
    return false;
  }
  if (settings.is_in_db && settings.min <= 0.0) {
    reader.reject("min", "is not above 0, as steps by factors need");
    return false;
  }
  const double hardest = settings.is_harder_below ? settings.min : settings.max;
  if (settings.start == hardest) {
    reader.reject("start", "is the limit already: correct answers could not make it harder");
    return false;
  }
  return true;
}

void check_room(MapReader& reader, const StaircaseSettings& settings) {
  const double low = offset_of(settings, settings.min);
  const double high = offset_of(settings, settings.max);
  if (settings.first_step * std::max(1.0, settings.easier_per_harder) > high - low) {
    reader.reject("first_step", "leads from one limit to the other: there is no room to move");
  }
  const double largest = settings.first_step * std::max(1.0, settings.easier_per_harder);
  if (largest * static_cast<double>(settings.max_trials) < std::min(-low, high)) {
    reader.reject("first_step", "is so small that no limit can be reached before it stops");
  }
  const double smallest = settings.min_step * std::min(1.0, settings.easier_per_harder);
  if (value_at(settings, low + smallest) == settings.min ||
      value_at(settings, high - smallest) == settings.max) {
    reader.reject("min_step", "is lost in rounding between min and max: the staircase cannot move");
  }
}

class Staircase final : public Procedure {
 public:
  std::string_view name() const override { return "staircase"; }
  std::shared_ptr<const TrackSettings> read(MapReader& reader) const override {
    StaircaseSettings settings;
    read_rule(reader, settings);
    settings.is_harder_below =
        reader.one_of<bool>("after_correct", {{"decrease", true}, {"increase", false}}, "decrease");
    read_steps(reader, settings);
    const bool has_room = read_limits(reader, settings);
    read_stop(reader, settings);
    if (!has_room || settings.first_step <= 0.0 || settings.min_step <= 0.0) {
      return nullptr;  // noted
    }
    check_room(reader, settings);
    return std::make_shared<const StaircaseStart>(settings);
  }
};
}  // namespace

const Procedure& staircase() {
  static const Staircase procedure;
  return procedure;
}
}  // namespace tapstudy::protocols
