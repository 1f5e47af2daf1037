#pragma once
#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/haptics/haptic_state.hpp"
#include "core/model/joints/joints.hpp"
#include "core/model/plate.hpp"
#include "core/settings/audio_settings.hpp"
#include "core/settings/device_settings.hpp"
#include "core/settings/render_settings.hpp"
#include "core/techniques/technique.hpp"
#include "protocols/form.hpp"
#include "protocols/surface/surface_file.hpp"
#include "protocols/tasks/task.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
// Simulated participants, for studies without people.
struct SimulatedTapSettings {
  std::vector<std::string> points;  // names of tapping points, visited in random order
  int taps_per_visit{8};
  int visits{2};             // to each alternative, where there are several
  double scatter_m{0.01};    // standard deviation of the place hit, on the plate
  double speed_m_s{0.3};     // median speed
  double speed_spread{0.2};  // standard deviation of its logarithm
  double dwell_s{0.25};
  double pause_s{0.35};
  double hover_m{0.02};
  double press_m{0.004};
};
struct SimulatedObserverSettings {
  // Internal noise on each felt feature; the default reproduces the accuracies of the paper's
  // Table 2.
  double noise_db{14.0};
  double threshold_n{1e-4};      // force amplitudes well below are not felt
  int familiarisation_taps{24};  // on each real plate, before the study
  std::string reference;         // the stimulus taken as reality, where a task needs one
  // Real plates have no technique: they are remembered as they vibrate by this one, the same for
  // every stimulus of a body.
  const core::Technique* reality{&core::natural_vibration()};
};
// How simulated participants differ: standard deviations between participants.
struct SimulatedPeopleSettings {
  double noise_spread{0.5};       // of the logarithm of the internal noise
  double threshold_spread{0.25};  // of the logarithm of the threshold
  double speed_spread{0.15};      // of the logarithm of the tapping speed
  double bias{0.5};               // towards each answer, in squared units of the internal noise
};
struct Simulation {
  core::HandBody hand;
  SimulatedTapSettings taps;
  SimulatedObserverSettings observer;
  SimulatedPeopleSettings people;
};

// A study as specified by its YAML file. Maps are sorted by name; lists keep the order of the file.

// What is found wrong only once models are built names "file:line:column: key.path" as well.
struct Material : core::Material {
  std::string damping_stated_at;
};
// Where on a plate it is tapped, by name [m, plate frame].
using Points = std::map<std::string, Eigen::Vector2d>;
struct Plate : core::Plate {
  double lateral_ratio{1.0};  // of this plate's lateral scale to the placement's
  Points tapping_points_m;
  std::string stated_at;
  std::map<std::string, core::Fixation> contact_points;  // regions, by name
};

// What a plate touches. The first of the plates is the one that is tapped.
struct Contacts : core::Joints {
  std::vector<std::shared_ptr<const Plate>> plates;
};

// A stimulus: a plate of a material, rendered by a technique; with `vary` a family of them, of
// which presented_stimulus.hpp makes the members. Plates and materials are shared between stimuli.
struct Stimulus {
  std::string name;
  std::string label;  // what participants read
  std::shared_ptr<const Plate> plate;
  std::shared_ptr<const Material> material;
  const core::Technique* technique{};
  std::shared_ptr<const core::RecordedTaps> recording;  // where its technique plays one
  std::map<std::string, std::string> factors;           // factor → level, for reports
  std::shared_ptr<const Contacts> contacts{};           // nullptr: it touches no other body
  AxisValues rendering{};                               // its own, where not the study's
  std::vector<AxisRange> vary{};                        // each axis once
  std::string vary_stated_at{};                         // as a Material's
  bool is_vary_refused{false};  // while a file is read in which an axis of it was rejected
  // False while a file is read in which one of these names was rejected.
  bool is_complete() const { return plate && material && technique != nullptr; }
};

// How the trials of a block follow one another.
//   listed                     as in the file, repetition after repetition
//   shuffle                    all presentations in one random order
//   shuffle_within_repetition  every stimulus once in random order, then again
//   williams                   a balanced Latin square over participants (Williams 1949)
enum class Order { listed, shuffle, shuffle_within_repetition, williams };

// A trial that took too long is presented again at the end of its block, or stored without answer.
enum class AtLimit { requeue, give_up };

// How sure a participant is, asked after each answer: 1 to steps.
struct Confidence {
  int steps{5};
  std::string low;   // what 1 means
  std::string high;  // what `steps` means
};

// A rest after so many trials of a block, or so much time since the last rest or the block's start,
// whichever comes first. The participant ends it, at the earliest after min_seconds.
struct Breaks {
  std::optional<int> every_trials{};
  std::optional<double> every_seconds{};
  double min_seconds{0.0};
  std::optional<double> max_seconds{};  // the rest then ends by itself; unset: the participant's
  bool are_due(int trials, double seconds) const {
    return (every_trials && trials >= *every_trials) ||
           (every_seconds && trials > 0 && seconds >= *every_seconds);
  }
};

// What a random order must satisfy; drawn uniformly from all that do.
struct OrderConstraints {
  int max_run{0};       // of one stimulus in a row; 0: any
  int min_distance{1};  // in trials, between two presentations of one stimulus
  bool are_any() const { return max_run > 0 || min_distance > 1; }
};

// Which of a participant's repeated choices is that participant's vote: what was chosen most often
// (of equals the earliest), or the first.
enum class Vote { majority, first };

// The alternatives of a trial come one after the other: an interval lasts this long from its go
// signal, and until it was tapped as often as must be. Nothing is rendered before, between and
// after intervals.
struct Intervals {
  double seconds{};
  double gap_seconds{0.5};  // before each
  int max_replays{0};       // of all of them, as the participant likes
};

// Taps that a simulated hand makes in the participant's place, who holds the device still and feels
// them: at one point, alike, again and again.
struct ScriptedTaps {
  std::string point;  // name of a tapping point
  double speed_m_s{};
  double dwell_s{0.25};
  double pause_s{0.5};  // until the next one begins
  bool operator==(const ScriptedTaps& other) const = default;
};

// What a participant must have done before an answer is taken, and how long it may take.
struct ExploreLimits {
  int min_contacts{1};        // with the plate, or each alternative
  bool must_visit_all{true};  // every alternative, not just the one that is chosen
  double min_seconds{0.0};
  std::optional<double> max_seconds;
  AtLimit at_limit{AtLimit::requeue};
  std::optional<Intervals> intervals{};         // nullopt: alternatives are switched freely
  std::optional<ScriptedTaps> scripted_taps{};  // nullopt: the participant taps
};

// Trials with a stimulus that nobody should mistake, at random places among a block's: they show
// who did not attend, and count for nothing else.
struct CatchTrials {
  int count{};                                  // in the block
  std::map<std::string, std::string> expected;  // by stimulus: its right answer
};

// A practice block ends once so many of the last answers were right; its repetitions are the most
// there can be. Who never gets there goes on to the study, or does not.
struct PracticeCriterion {
  int correct{};
  int of_last{};
  bool must_be_met{false};
};

// What a block's stimuli are to the participant: rendered by the device, or the plates themselves,
// which the operator mounts.
enum class Presented { virtual_plates, real_plates };

inline constexpr std::size_t max_stimuli = 26;  // of a block: they have letters as labels

struct Block {
  std::string name;
  std::string session;  // of the protocol's sessions; empty: it has none
  std::string measure;  // its name in the file, to which sessions that share it add theirs
  const Task* task{};
  std::string question;
  std::vector<std::string> stimuli;
  // What can be answered, if not one of the above: names of stimuli, or levels of response_factor.
  std::vector<std::string> responses;
  std::string response_factor;                         // empty: stimuli are answered
  std::map<std::string, std::string> response_labels;  // by level, where it is not the label itself
  std::map<std::string, std::string> right_response;   // by stimulus; empty: none is right
  std::optional<Comparison> comparison;
  std::string tie;  // paired: what participants read for no difference; empty: they must choose
  std::optional<RatingScale> rating;
  std::optional<ValuesOnAxis> on_axis;
  std::optional<Modulus> modulus;
  std::optional<Adjustment> adjustment;
  std::vector<std::string> keys;  // that answer, in the order of the options; empty: their places
  int alternatives{};             // presented in a trial, where the task leaves a choice
  Presented presented{Presented::virtual_plates};
  std::optional<CatchTrials> catch_trials;
  std::optional<PracticeCriterion> criterion;
  bool allows_correction{false};  // of the last answer, by the participant
  int repetitions{1};
  Order order{Order::shuffle};
  OrderConstraints constraints;
  bool is_practice{false};
  bool is_fixed{false};  // in its place, whatever the order of the blocks
  // The measure of an earlier block, with whose trials its own are mixed; empty: they come by
  // themselves.
  std::string mixed_with;
  bool gives_feedback{false};  // which answer was right
  std::string instructions;    // before its first trial; may be empty
  std::optional<Picture> instructions_picture;
  std::optional<Confidence> confidence;
  std::optional<Breaks> breaks;
  std::optional<AnswerCondition> presented_if;  // on forms_before; unset: to all
  std::vector<std::string> forms_after;         // names of forms, asked after its last trial
  ExploreLimits explore;
  Vote vote{Vote::majority};
  int max_late_impact_repeats{0};  // of a trial with an impact just after a late tick
};

// Whether its procedures may know enough before their last trial.
bool may_procedures_end_early(const Block& block);
// Likewise, or its criterion may be met.
bool may_end_early(const Block& block);
// To a participant who filled in these forms; also where the condition's form was not filled in.
bool is_presented(const Block& block, const FilledForms& filled);
// A procedure asked for that answer: of constant stimuli a level would lack one.
bool do_skipped_trials_come_again(const Block& block);
// The answers that its task takes, with the block's keys.
Answers answers_of(const Block& block, const Protocol& protocol);
// Its stimuli, those of its catch trials, and what is presented beside them.
std::vector<std::string> all_presented(const Block& block);

// How the blocks of a session follow one another: listed, shuffle or williams. Those named exchange
// their places, each with the practice blocks directly before it; the others stay. Practice before
// the first of all moves with it only where each block that moves has practice of its own; else it
// is for all of them, and stays first.
struct BlockOrder {
  Order order{Order::listed};
  std::vector<std::string> blocks;  // none of practice; empty: all
};

// Of participants, each of whom is in one: a group does these blocks, and no others.
struct Group {
  std::string name;
  std::string label;                // what reports call it
  std::vector<std::string> blocks;  // in the file's order
  // Those that change places with one another, in the group's order; empty: as in block_order.
  std::vector<std::string> block_order{};
  // Of a block's stimuli those that the group is presented, in this order; unset: all of them.
  std::map<std::string, std::vector<std::string>> stimuli{};
};

// One of the times that a participant comes, on another day, say.
struct PlannedSession {
  std::string name;
  std::vector<std::string> blocks{};  // in the file's order
  // Since the session before began.
  std::optional<double> min_since_last_s{};
  std::optional<double> max_since_last_s{};
};

// A pre-registered hypothesis; reports treat only these as planned tests.
struct Hypothesis {
  std::string name;
  std::string statement;
  std::string block;
  Claim claim{};
  std::string stimulus;  // chosen_above_chance, rated_highest: which; equivalent: one of them
  std::vector<std::string> factors;  // interaction: of these two
  std::string other_stimulus;        // equivalent: to this one
  std::string other_block;           // equivalent: the whole block to this one; threshold_ratio
  double within{};  // equivalent: the largest difference that is none; of thresholds the ratio
  double below{};   // threshold_below: the level that thresholds are expected to lie below
  std::vector<std::string> groups{};  // groups_differ: these two
};

// What the pages of a session show. Of the plate its shape, in neutral colour.
struct Display {
  bool shows_plate{true};
  bool shows_tapping_points{true};
  bool shows_fixations{false};
  bool is_operator_blind{false};  // to what is presented and answered
};

inline constexpr int max_participants = 10'000;

// Modes that are left out of what is rendered: at and near every tapping point they stay so far
// below the strongest mode there.
struct DroppedModes {
  double below_db{60.0};  // > 0
  double within_m{0.03};  // of a tapping point, on the plate
};

struct Protocol {
  std::string text;           // the file, whole
  Translations translations;  // of what participants read
  // The files that its plates name, whole, and each repaired surface after that which it is made
  // of.
  std::vector<SurfaceSource> surfaces;
  std::vector<Picture> pictures;  // each file once
  std::string title;
  std::string notes;
  std::optional<int> participants;  // that are planned
  std::string instructions;         // for participants, before the first trial; may be empty
  std::optional<Picture> instructions_picture;
  double band_limit_hz{};
  double rate_hz{};
  core::RenderSettings rendering;
  bool stores_actuator{true};              // what is rendered above the crossover, with each trial
  std::optional<DroppedModes> drop_modes;  // nullopt: none
  core::Placement placement;
  std::map<std::string, std::shared_ptr<const Material>> materials;
  std::map<std::string, std::shared_ptr<const Plate>> plates;
  std::map<std::string, std::shared_ptr<const core::RecordedTaps>> recordings;
  std::map<std::string, std::shared_ptr<const Contacts>> contacts;
  Points tapping_points_m;  // plate frame, at the placement's scale
  std::vector<Stimulus> stimuli;
  std::map<std::string, Form> forms;
  std::vector<std::string> forms_before;  // the first trial of a session
  std::vector<std::string> forms_after;   // the last
  Display display;
  std::vector<Block> blocks;  // in the file's order
  BlockOrder block_order;
  std::vector<PlannedSession> sessions;    // in order, two or more; none: a participant comes once
  std::vector<Group> groups;               // two or more; none: every participant does all blocks
  std::uint64_t counterbalancing_seed{1};  // which participant gets which balanced order
  std::vector<Hypothesis> hypotheses;
  std::optional<core::MaskingNoise> masking;  // in every trial
  Simulation simulation;

  // Throws InvalidInput listing the known stimuli.
  const Stimulus& stimulus(const std::string& name) const;
  const Block& block(const std::string& name) const;
  const Block* find_block(const std::string& name) const;  // nullptr if there is none
  // The block of the same session with whose trials its own are mixed; without one, itself.
  const Block& leader(const Block& block) const;
  // Whether these blocks, of one session, are one sequence of trials.
  bool are_mixed(const Block& one, const Block& other) const;
  const Group& group(const std::string& name) const;
  // nullptr if there is none.
  const PlannedSession* find_session(const std::string& name) const;
};
}  // namespace tapstudy::protocols
