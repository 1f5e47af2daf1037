#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/random/rng.hpp"
#include "protocols/axes/axis_range.hpp"
#include "protocols/procedures/procedure.hpp"
#include "protocols/tasks/answers.hpp"
namespace tapstudy::protocols {
class MapReader;
class Task;
struct Block;
struct Protocol;
struct SimulatedTapSettings;
struct Simulation;

// Claims that a hypothesis can make about a block.
enum class Claim {
  accuracy_above_chance,
  chosen_above_chance,
  rated_highest,
  interaction,
  equivalent,
  threshold_ratio,
  threshold_below,
  groups_differ
};

// One of the things that can be felt in a trial.
struct Alternative {
  std::string stimulus;
  AxisValues values{};        // by axis; of axes without one the stimulus's own
  bool is_comparison{false};  // not the standard; where a procedure varies it, values are set later
};

struct PlannedTrial {
  int number{};  // from 1, in the order presented
  std::string block;
  const Task* task{};
  bool is_practice{false};
  int repetition{};  // from 1
  std::vector<Alternative> alternatives;
  bool is_catch{false};
};

// What the last alternative of a trial can be set to while it is felt, and where it starts.
inline constexpr std::size_t max_settings = 100;
struct Settings {
  std::vector<AxisValues> values;
  std::size_t start{};
};

// Participant and block for which an order is drawn.
struct Draw {
  std::uint64_t participant_seed{};
  int order_index{};  // which of the balanced orders, from 0
  std::size_t block_index{};
  std::uint64_t counterbalancing_seed{};  // of the study
  // Of the places of catch trials, which stay where they are in every other draw of the order.
  std::uint64_t catch_seed{};
};

// What a simulated participant knows from before the study: how a real plate feels, or a rendered
// member of a family.
struct Remembered {
  std::string key;  // by which the participant thinks of it
  std::string stimulus;
  AxisValues values{};
  bool is_real{true};
};

// The actions of a simulated participant in a trial. The rendered stimulus is never disclosed.
class SimulatedTouch {
 public:
  virtual ~SimulatedTouch() = default;
  // Switches to an alternative, if there are several, and taps there for one visit.
  virtual void visit(std::size_t alternative) = 0;
  // Which of these remembered stimuli is the first alternative most like?
  virtual std::size_t most_similar_stimulus(const std::vector<std::string>& stimuli) = 0;
  // Which of the alternatives is most like this remembered stimulus?
  virtual std::size_t most_similar_alternative(const std::string& stimulus) = 0;
  // Where an alternative lies on the way from one remembered stimulus, 0, to another, 1.
  virtual double position(std::size_t alternative, const std::string& from,
                          const std::string& to) = 0;
  // How far apart two alternatives are, and one from a remembered stimulus, as a mean square in
  // units of the internal noise: about 1 for two of the same.
  virtual double distance(std::size_t first, std::size_t second) = 0;
  virtual double distance(std::size_t alternative, const std::string& stimulus) = 0;
  // Whether the first two alternatives are further apart than two of this remembered stimulus, each
  // felt as often, are in so large a share of cases, as was learned from tapping it.
  virtual bool are_different(const std::string& stimulus, double share) = 0;
  // How strongly an alternative is felt, in decibels above the threshold: the mean over what is
  // felt of it, blurred by the internal noise.
  virtual double level_db(std::size_t alternative) = 0;
  // Moves the last alternative by so many settings; what was felt of it is of the past. False: it
  // cannot be moved so far.
  virtual bool adjust(int settings) = 0;
  virtual std::size_t setting() const = 0;  // where it is, for the answer
  virtual core::Rng& rng() = 0;             // of the hand
};

// A psychophysical task: what is presented, which answers are allowed, which is correct, what is
// stored. Names the statistic (in analysis) that summarises its blocks. To add one: a file beside
// this with its class, and a row in task_parts.cpp; nothing else refers to a task by name.
class Task {
 public:
  virtual ~Task() = default;
  virtual std::string_view name() const = 0;                         // in protocols and stores
  virtual std::string_view statistic(const Block& block) const = 0;  // that summarises it

  // Its own keys of a block; problems go to the reader. The common keys are read already.
  virtual void read(MapReader& reader, const Protocol& protocol, Block& block) const = 0;
  virtual std::optional<Claim> claim() const = 0;  // nullopt: none
  // Whether simulated participants need simulation.observer.reference.
  virtual bool needs_reference() const = 0;
  // Whether some answers are right and others wrong.
  virtual bool has_correct_answer() const = 0;
  // Whether the block's order, Williams's among others, decides what is presented when.
  virtual bool uses_order() const = 0;
  // Whether a trial can be of real plates, which are mounted one at a time.
  virtual bool can_present_real_plates() const = 0;
  // Whether answers are counted against a chance level; ratings are not.
  virtual bool has_chance_level() const { return true; }
  // Of what success() says, where there is one: one option of those that can be answered.
  virtual double chance_level(const Block& block, const Protocol& protocol) const;

  // The block's trials, numbers left open.
  virtual std::vector<PlannedTrial> trials(const Block& block, const Draw& draw) const = 0;
  virtual std::size_t trials_per_repetition(const Block& block) const = 0;

  // The allowed answers; how one of them, as answer_in gives it, is stored; the labels by which a
  // participant switches between the alternatives of a trial (empty: nothing to switch).
  virtual Answers answers(const Block& block, const Protocol& protocol) const = 0;
  virtual std::string response(const PlannedTrial& /*trial*/, const Block& /*block*/,
                               const std::string& answer) const {
    return answer;
  }
  virtual std::vector<std::string> alternative_labels(const PlannedTrial& trial) const = 0;
  // Where the participant adjusts the last alternative; nullopt: all are as they are.
  virtual std::optional<Settings> settings(const PlannedTrial& /*trial*/,
                                           const Block& /*block*/) const {
    return std::nullopt;
  }
  // What an answer tells the procedure that varies the comparison: one of its outcomes; nullopt if
  // nothing, because no comparison was presented beside a standard.
  virtual std::optional<std::size_t> outcome(const PlannedTrial& trial, const Block& block,
                                             const std::string& response) const;
  // Of right answers, by chance; 0 where none is right.
  virtual double guess_rate(const Block& block, const Protocol& protocol) const;
  // Whether answers are "there is a difference", so that participants set the rate of guesses.
  virtual bool has_own_guess_rate() const { return false; }
  // Of d', in analysis; empty: none.
  virtual std::string_view decision_model(const Block& /*block*/) const { return {}; }
  // nullopt if the task has no correct answer.
  virtual std::optional<bool> is_correct(const PlannedTrial& trial, const Block& block,
                                         const std::string& response) const = 0;
  // Of one participant's answers to a block, how many are counted as independent ones.
  virtual int counted_answers(const Block& block) const = 0;
  // "of 80 answers 27 must …"
  virtual std::string_view success() const = 0;

  // For simulated participants: what to remember, the number of visits per trial, and the decision
  // rule, which returns an answer.
  virtual std::vector<Remembered> remembered(const Block& block,
                                             const Simulation& simulation) const = 0;
  virtual int visits(const Block& block, const SimulatedTapSettings& taps) const = 0;
  virtual std::string simulated_answer(const Block& block, const Simulation& simulation,
                                       SimulatedTouch& touch) const = 0;
};

// What is rendered in a trial, by position in stores and traces: its alternatives, the last of them
// once for each of its settings, if it has some.
std::vector<Alternative> rendered(const PlannedTrial& trial, const Block& block);

// All there are. nullptr if there is none of that name.
const std::vector<const Task*>& tasks();
const Task* find_task(std::string_view name);

// "A", "B", … for alternatives that must not be known by name.
std::string blind_label(std::size_t position);

// What the tasks of a block have of their own.

// Of the standard. Levels have a sign on `either` only.
enum class Side { above, below, either };
// A comparison that differs from its standard along an axis of their family, by a level that
// procedures choose: a fraction of the standard, or a difference in the axis's unit.
struct Comparison {
  std::string axis;
  // All alternatives of a trial have the same values on these, which a procedure of several axes
  // chooses as they are: the threshold along the axis above depends on them.
  std::vector<std::string> further_axes;
  double standard{};
  bool is_fraction{true};
  Side side{Side::above};
  bool is_standard_right{false};  // what is asked for is the standard
  // Of the function that is fitted to the answers.
  core::PsychometricShape shape{core::PsychometricShape::weibull};
  std::vector<std::shared_ptr<const TrackSettings>> tracks;  // interleaved; at least one
  double value_at(double level) const {
    const double difference = is_fraction ? level * standard : level;
    return side == Side::below ? standard - difference : standard + difference;
  }
  double level_of(double value) const {
    const double difference = side == Side::below ? standard - value : value - standard;
    return is_fraction ? difference / standard : difference;
  }
};

// On which a stimulus is rated: steps from 1 (Likert), or a mark on a line from 0, low, to 1, high
// (visual analogue).
enum class ScaleKind { likert, visual_analogue };
struct RatingScale {
  ScaleKind kind{ScaleKind::likert};
  int steps{7};  // likert
  std::string low;
  std::string high;
};

// Values of an axis at which every stimulus of a block is presented.
struct ValuesOnAxis {
  std::string axis;
  std::vector<double> values;  // from low to high, as presented
};

// A stimulus that is presented beside the one to be judged, with the number that it is said to
// have.
struct Modulus {
  std::string stimulus;
  double number{};
};

// One stimulus is moved along an axis of its family until it feels equal to a standard: the same
// stimulus at one value, or another stimulus.
struct Adjustment {
  std::string axis;
  std::vector<double> values;  // that it can be set to, from low to high, as presented
  Spacing spacing{Spacing::linear};
  std::optional<double> standard;  // on the axis
  std::string reference;           // the other stimulus, where there is no such value
  // Runs start below or above it: the standard, or the middle of the values as they are spaced.
  double middle() const {
    constexpr double half = 0.5;
    return standard.value_or(between(values.front(), values.back(), spacing, half));
  }
};

// One stimulus is presented; the answer names the stimulus it resembles (paper section 5.2.1).
const Task& identification();
// Several stimuli are switched between freely under blind labels; the answer is one of them (paper
// sections 5.2.2, 5.2.3).
const Task& choice();
// Which of several is the comparison? m-alternative forced choice along an axis.
const Task& comparison();
const Task& same_different();
// Which of three or four differs? Triangle test, and oddity of four.
const Task& odd_one_out();
const Task& abx();
// Which of two to four is the sample?
const Task& match_to_sample();
// Which of two? All pairs of the stimuli.
const Task& paired();
// All of three to eight in order.
const Task& ranking();
// One stimulus, on a scale of steps.
const Task& rating();
// One stimulus, by a number; beside one whose number is told, or by itself.
const Task& magnitude();
// One stimulus is moved along an axis until it feels equal to a standard.
const Task& adjustment();
}  // namespace tapstudy::protocols
