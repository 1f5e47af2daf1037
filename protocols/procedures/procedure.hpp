#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/psychometric_function.hpp"
#include "core/text/citations.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
using core::operator""_source;

// A change of direction of a staircase: at which trial (from 1) and at which value it turned.
struct Reversal {
  std::size_t trial{};
  double value{};
};
// The smallest value of the grid up to which the distribution holds at least this probability.
struct Quantile {
  double probability{};
  double value{};
};
// Marginal posterior of one parameter; the mode is that of the joint posterior (Watson 2017).
struct ParameterPosterior {
  std::string name;
  double mean{};
  double mode{};
  double standard_deviation{};
  std::vector<Quantile> quantiles;  // 0.025, 0.25, 0.5, 0.75, 0.975
};
struct TrackSummary {
  std::size_t trials{};  // observed
  bool is_finished{};
  // Staircase: mean of the last reversals, once there are enough. QUEST+: posterior mean of the
  // first parameter, the threshold. Constant stimuli: none.
  std::optional<double> estimate;
  // Proportion correct at which a staircase settles.
  std::optional<double> target;
  std::vector<Reversal> reversals;
  std::size_t trials_at_limit{};  // of a staircase, at its min or max
  std::vector<ParameterPosterior> parameters;
};

// A running procedure. It depends on its settings, its seed and what was observed, in order, and on
// nothing else: a session is resumed by observing its answers again. Not for several threads.
//
// Requested and presented values may differ, because only some stimuli can be built:
// - A staircase steps from the value that it requested. From the presented one, a step smaller than
//   half the distance of buildable values would be rounded away each time. Reversals and estimate
//   are requested values, which is off by at most half that distance.
// - QUEST+ updates by the likelihood of the value that was presented, on its grid or not: the
// answer
//   was given to that one.
// - Constant stimuli only count.
class Track {
 public:
  Track(std::size_t axes, std::size_t outcomes) : axes_{axes}, outcomes_{outcomes} {}
  virtual ~Track() = default;

  // The value on each axis of the next stimulus; nullopt: finished.
  std::optional<std::vector<double>> next() const;
  virtual bool is_finished() const = 0;
  // presented: a finite value on each axis. outcome: 0 incorrect ("no"), 1 correct ("yes"); or one
  // of several, from 0. Throws InvalidInput for any other, after the end, and where the outcome has
  // probability 0 whatever the parameters; the track is then as it was.
  void observe(const std::vector<double>& presented, std::size_t outcome);
  std::size_t trials() const { return trials_; }
  virtual TrackSummary summary() const = 0;

 private:
  // Asked for only while it is not finished.
  virtual std::vector<double> request() const = 0;
  // All checked; trials() does not count it yet.
  virtual void take(const std::vector<double>& presented, std::size_t outcome) = 0;

  std::size_t axes_;
  std::size_t outcomes_;
  std::size_t trials_{0};
};

// What was read of a procedure; starts any number of tracks.
class TrackSettings {
 public:
  virtual ~TrackSettings() = default;
  virtual std::size_t axes() const = 0;      // of a stimulus
  virtual std::size_t outcomes() const = 0;  // of a trial
  virtual std::size_t max_trials() const = 0;
  // Whether it may stop before: what it takes then depends on the answers.
  virtual bool may_end_early() const { return false; }
  // On each axis the least and the greatest value that may be requested.
  virtual std::vector<std::pair<double, double>> ranges() const = 0;
  // The guess rates that it holds possible; nullopt: it makes no assumption of any.
  virtual std::optional<std::pair<double, double>> guess_rates() const { return std::nullopt; }
  // The psychometric function that it takes answers to follow; nullopt: it assumes none.
  virtual std::optional<core::PsychometricShape> shape() const { return std::nullopt; }
  // The proportion correct at which it settles; nullopt: at none.
  virtual std::optional<double> settles_at() const { return std::nullopt; }
  // Whether right answers lead to lower levels.
  virtual bool is_harder_below() const { return true; }
  virtual std::unique_ptr<Track> start(std::uint64_t seed) const = 0;
  // As a methods section says it, with its source: "a 1 up, 2 down staircase (Levitt 1971)".
  virtual core::CitingText describe() const = 0;
};

// A psychophysical procedure: which stimulus value comes next. To add one: a file beside this with
// its class, a row in procedure.cpp; nothing else refers to a procedure by name.
class Procedure {
 public:
  virtual ~Procedure() = default;
  virtual std::string_view name() const = 0;
  virtual std::string_view meaning() const = 0;  // in the reference of keys
  // Its own keys; problems go to the reader. nullptr: no track could be started with these, and the
  // problem was noted.
  virtual std::shared_ptr<const TrackSettings> read(MapReader& reader) const = 0;
};

// All there are.
const std::vector<const Procedure*>& procedures();

// A mapping with one key, the procedure's name, to the procedure's own keys. nullptr as above.
std::shared_ptr<const TrackSettings> read_procedure(MapReader& reader);

// Method of constant stimuli: listed values in random order.
const Procedure& constant_stimuli();
// Up-down staircases: transformed (Levitt 1971) and weighted (Kaernbach 1991).
const Procedure& staircase();
// QUEST+ (Watson 2017): the stimulus of least expected entropy of the parameters.
const Procedure& quest_plus();
// The psi method (Kontsevich & Tyler 1999): QUEST+ of one stimulus axis with guess and lapse rate
// fixed.
const Procedure& psi();

// Values of a stimulus or a parameter, in its own unit.
inline constexpr double largest_value = 1e9;
inline constexpr int max_grid_values = 10'000;

// The keys of a grid: `values`, listed in increasing order; or `min`, `max`, `count` and `spacing`,
// linear or log. At least one value, strictly increasing. nullopt: a problem was noted. What values
// the schema allows is stated; the caller checks it.
std::optional<std::vector<double>> read_grid(MapReader& reader,
                                             const Range& stated = {-largest_value, largest_value});
}  // namespace tapstudy::protocols
