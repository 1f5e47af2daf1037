// What a protocol says of a staircase.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "protocols/procedures/procedure.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
// An up-down staircase. Correct answers in a row make the next stimulus harder, incorrect ones in a
// row easier; each change ends the row.
//
// Transformed (Levitt 1971): n_down correct, or n_up incorrect, in a row; equal steps. It settles
//   where either change is as likely as the other: at n_up = 1, psi = 0.5^(1/n_down).
// Weighted (Kaernbach 1991): one answer each; the step towards easier is target / (1 - target)
//   times the one towards harder. It settles at psi = target.
//
// Steps are added to the value (linear), or are decibels of it: value = start 10^(dB/20). Each
// reversal halves the step until min_step. A step stops at min and max; that counts as a step in
// its direction. The value of a reversal is that of the trial whose answer turned the staircase.
struct StaircaseSettings {
  double start{};
  double min{};
  double max{};
  bool is_in_db{false};
  bool is_harder_below{true};  // correct answers decrease the value
  double first_step{};         // towards harder; in the unit of the value, or in dB
  double min_step{};
  double easier_per_harder{1.0};  // ratio of steps
  int n_down{1};
  int n_up{1};
  std::size_t max_trials{};
  std::optional<std::size_t> max_reversals;
  // Of the estimate: the last so many reversals, even, so that peaks and valleys are as many
  // (Wetherill & Levitt 1965). Averaged in the unit of steps: in dB a geometric mean.
  std::size_t estimate_reversals{};
};

// Where it settles: the proportion correct at which steps in both directions balance.
double staircase_target(const StaircaseSettings& settings);

// Values are `start` moved by an offset in the unit of the steps.
double offset_of(const StaircaseSettings& settings, double value);
double value_at(const StaircaseSettings& settings, double offset);

std::unique_ptr<Track> start_staircase(const StaircaseSettings& settings);

namespace {
// P(n successes in a row come before m failures in a row), success of probability p each
// (Feller 1968, XIII.7).
double run_probability(double p, int n, int m) {
  const double q = 1.0 - p;
  const double successes = std::pow(p, n - 1);
  const double failures = std::pow(q, m - 1);
  return successes * (1.0 - std::pow(q, m)) / (successes + failures - successes * failures);
}

class StaircaseTrack final : public Track {
 public:
  explicit StaircaseTrack(const StaircaseSettings& settings)
      : Track{1, 2}, settings_{settings}, step_{settings.first_step} {}

  bool is_finished() const override {
    return trials() >= settings_.max_trials ||
           (settings_.max_reversals && reversals_.size() >= *settings_.max_reversals);
  }

  TrackSummary summary() const override {
    TrackSummary summary;
    summary.trials = trials();
    summary.is_finished = is_finished();
    summary.target = staircase_target(settings_);
    summary.trials_at_limit = trials_at_limit_;
    summary.reversals = reversals_;
    const std::size_t n = settings_.estimate_reversals;
    if (n > 0 && turns_.size() >= n) {
      const double sum =
          std::accumulate(turns_.end() - static_cast<std::ptrdiff_t>(n), turns_.end(), 0.0);
      summary.estimate = value_at(settings_, sum / static_cast<double>(n));
    }
    return summary;
  }

 private:
  std::vector<double> request() const override { return {value_at(settings_, offset_)}; }

  void take(const std::vector<double>& /*presented*/, std::size_t outcome) override {
    const bool is_correct = outcome == 1;
    trials_at_limit_ += is_at_limit() ? 1 : 0;
    in_a_row_ = is_correct == was_correct_ ? in_a_row_ + 1 : 1;
    was_correct_ = is_correct;
    if (in_a_row_ < (is_correct ? settings_.n_down : settings_.n_up)) {
      return;
    }
    in_a_row_ = 0;
    if (was_harder_ && *was_harder_ != is_correct) {
      reversals_.push_back({trials() + 1, value_at(settings_, offset_)});
      turns_.push_back(offset_);
      step_ = std::max(step_ / 2.0, settings_.min_step);
    }
    was_harder_ = is_correct;
    move(is_correct);
  }

  void move(bool is_harder) {
    const double step = is_harder ? step_ : step_ * settings_.easier_per_harder;
    const double signed_step = is_harder == settings_.is_harder_below ? -step : step;
    offset_ = std::clamp(offset_ + signed_step, offset_of(settings_, settings_.min),
                         offset_of(settings_, settings_.max));
  }

  bool is_at_limit() const {
    const double value = value_at(settings_, offset_);
    return value <= settings_.min || value >= settings_.max;
  }

  StaircaseSettings settings_;
  double step_;
  double offset_{0.0};
  int in_a_row_{0};
  bool was_correct_{false};
  std::optional<bool> was_harder_;  // the last step
  std::vector<Reversal> reversals_;
  std::vector<double> turns_;  // their offsets
  std::size_t trials_at_limit_{0};
};
}  // namespace

double staircase_target(const StaircaseSettings& settings) {
  // P(harder) 1 = P(easier) easier_per_harder
  const double balance = settings.easier_per_harder / (1.0 + settings.easier_per_harder);
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (run_probability(middle, settings.n_down, settings.n_up) < balance ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double offset_of(const StaircaseSettings& settings, double value) {
  return settings.is_in_db ? 20.0 * std::log10(value / settings.start) : value - settings.start;
}

// Rounding does not lead beyond the limits.
double value_at(const StaircaseSettings& settings, double offset) {
  const double value =
      settings.is_in_db ? settings.start * std::pow(10.0, offset / 20.0) : settings.start + offset;
  return std::clamp(value, settings.min, settings.max);
}

std::unique_ptr<Track> start_staircase(const StaircaseSettings& settings) {
  return std::make_unique<StaircaseTrack>(settings);
}

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
  core::CitingText describe() const override {
    const core::CitingText rule =
        settings_.easier_per_harder == 1.0
            ? core::citing("a {} up, {} down staircase ({})", settings_.n_up, settings_.n_down,
                           "Levitt 1971"_source)
            : core::citing("a weighted up-down staircase ({})", "Kaernbach 1991"_source);
    return core::citing("{} that settles at {:.3g} correct", rule, staircase_target(settings_));
  }
  // Nothing in it is random.
  std::unique_ptr<Track> start(std::uint64_t /*seed*/) const override {
    return start_staircase(settings_);
  }

 private:
  StaircaseSettings settings_;
};

// In dB where the step is a factor.
double read_step(MapReader& reader, const Key& key, StepKind kind,
                 std::optional<double> otherwise) {
  const double step = reader.number(key, Range::positive(largest_value), otherwise);
  if (reader.has(key.name) && kind == StepKind::factor && step <= 1.0) {
    reader.reject(key.name, "is not above 1, as a factor must be to move");
  }
  return step;
}

void read_steps(MapReader& reader, StaircaseSettings& settings) {
  const auto kind = reader.one_of<StepKind>(
      {"steps", "added to the value, in decibels of it (20 log10), or factors of it"},
      {{"linear", StepKind::linear}, {"db", StepKind::db}, {"factor", StepKind::factor}});
  settings.is_in_db = kind != StepKind::linear;
  settings.first_step = read_step(
      reader,
      {"first_step", "step after correct answers until the first reversal; a factor is above 1"},
      kind, {});
  settings.min_step = read_step(
      reader,
      {"min_step",
       "each reversal halves the step (of a factor: its logarithm) until this; unset: no halving"},
      kind, settings.first_step);
  if (settings.min_step > settings.first_step) {
    reader.reject("min_step", "is above first_step");
  }
  if (kind == StepKind::factor) {
    settings.first_step = 20.0 * std::log10(settings.first_step);
    settings.min_step = 20.0 * std::log10(settings.min_step);
  }
}

void read_rule(MapReader& reader, StaircaseSettings& settings) {
  const auto rule =
      reader.one_of<Rule>({"rule",
                           "transformed: so many answers in a row make a step; "
                           "weighted: each answer makes one, of unequal size"},
                          {{"transformed", Rule::transformed}, {"weighted", Rule::weighted}});
  const bool is_weighted = rule == Rule::weighted;
  for (const char* key : {"n_down", "n_up"}) {
    if (is_weighted) {
      reader.refuse(key, "is for rule: transformed only");
    }
  }
  if (!is_weighted) {
    reader.refuse("target", "is for rule: weighted only");
  }
  if (is_weighted) {
    const double target =
        reader.number({"target",
                       "proportion correct to settle at; the step after an incorrect answer is "
                       "target / (1 - target) times the other"},
                      {0.05, 0.95});
    settings.easier_per_harder = target / (1.0 - target);
  } else {
    settings.n_down = reader.integer(
        {"n_down", "correct answers in a row that make the next stimulus harder"}, 1, 10);
    settings.n_up = reader.integer(
        {"n_up", "incorrect answers in a row that make it easier; with rule: transformed only"}, 1,
        10, 1);
  }
}

void read_stop(MapReader& top, StaircaseSettings& settings) {
  top.map(
      {"stop", "when the staircase ends: whichever comes first"}, MapReader::Presence::required,
      [&](MapReader& reader) {
        if (reader.count_given({"reversals", "trials"}, MapReader::Presence::at_least_one) == 0) {
          reader.reject("has neither reversals nor trials");
        }
        if (reader.has("reversals")) {
          settings.max_reversals = static_cast<std::size_t>(
              reader.integer({"reversals", "after so many reversals; unset: any number"}, 1,
                             max_staircase_reversals));
        }
        settings.max_trials = static_cast<std::size_t>(reader.integer(
            {"trials", "after so many trials"}, 1, max_staircase_trials, max_staircase_trials));
      });
  settings.estimate_reversals = static_cast<std::size_t>(
      top.integer({"estimate_reversals",
                   "the estimate is the mean of the last so many reversals, an even number"},
                  2, max_staircase_reversals));
  top.check("estimate_reversals", settings.estimate_reversals % 2 == 0, R"({"multipleOf": 2})",
            "is odd: as many peaks as valleys are averaged");
  // the first trial is no reversal
  const std::size_t attainable = settings.max_trials - 1;
  if (settings.estimate_reversals >
      std::min(attainable, settings.max_reversals.value_or(attainable))) {
    top.reject("estimate_reversals", "is more than there are before the staircase stops");
  }
}

bool read_limits(MapReader& reader, StaircaseSettings& settings) {
  const Range any{-largest_value, largest_value};
  settings.start = reader.number({"start", "first value, from min to max"}, any);
  settings.min = reader.number({"min", "lowest value; above 0 with steps: db or factor"}, any);
  settings.max = reader.number({"max", "highest value, above min"}, any);
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
  std::string_view meaning() const override { return "up-down staircase"; }
  std::shared_ptr<const TrackSettings> read(MapReader& reader) const override {
    StaircaseSettings settings;
    read_rule(reader, settings);
    settings.is_harder_below = reader.one_of<bool>(
        {"after_correct", "whether correct answers decrease or increase the value"},
        {{"decrease", true}, {"increase", false}}, "decrease");
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
