#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>
namespace tapstudy::results {
// The contents of a study database as plain rows. Names and units are those of the SQL columns.

// Simulated and pilot sessions never enter the report of a real study unless asked for.
enum class Mode { real, pilot, simulated };
std::string to_text(Mode mode);
Mode mode_from(const std::string& text);

// Complete contents of a file named by the protocol, or of a surface made of one because the
// protocol asks for its repair; compressed in the database.
struct SurfaceRow {
  std::string file;  // as the protocol names it, or how the surface was made
  std::string sha256;
  std::string bytes;
  bool operator==(const SurfaceRow& other) const = default;
};

struct StudyRow {
  std::string title;
  std::string protocol_file;
  std::string protocol_text;
  std::string protocol_sha256;
  std::vector<SurfaceRow> surfaces;
};

// The group of participants that somebody is in, of those that the protocol has.
struct GroupRow {
  std::string name;
  bool is_given{};  // by the operator; else it is that of the participant's place in the study
  bool operator==(const GroupRow& other) const = default;
};

// How somebody came to be in it.
std::string assignment_of(const GroupRow& group);
GroupRow group_from(const std::string& name, const std::string& assignment);

// One session of one participant. Stored before the first trial, with all data to reproduce it.
struct SessionRow {
  std::int64_t id{};
  std::string participant_id;
  int participant_index{};  // from 0 within its mode
  int order_index{};        // which of the balanced orders, from 0
  Mode mode{Mode::real};
  std::uint64_t seed{};
  std::string planned_order;              // one line a trial
  std::string language;                   // of what the participant read
  std::optional<std::int64_t> resumes{};  // the session it continues
  double rate_hz{};
  std::string rig_text;
  std::string device;
  std::string scheduler;
  std::string doctor;  // diagnosis of the machine before the session, JSON
  std::string program_version;
  std::string git_hash;
  std::string compiler;
  std::string started_utc;
  std::optional<GroupRow> group{};               // unset: the protocol has no groups
  std::optional<std::string> planned_session{};  // of the protocol's; unset: it has none
  std::optional<std::string> protocol_text{};    // unset: the study's; else with other texts
};

// Values of a stimulus on the axes along which it varies, by axis.
using AxisValues = std::map<std::string, double>;
struct AlternativeRow {
  int position{};     // from 0
  std::string label;  // blind label shown to the participant; empty if only one
  std::string stimulus;
  AxisValues axis_values{};  // as presented; empty if it does not vary
  bool is_comparison{};      // not the standard that it is compared with
};
// The alternatives of each trial by its id, in order of position.
using AlternativesOfTrials = std::map<std::int64_t, std::vector<AlternativeRow>>;
struct ResponseRow {
  std::string response;                             // as the task stores it: a stimulus's name
  std::optional<bool> is_correct;                   // unset if no answer is correct
  double response_time_s{};                         // from the start of the trial
  std::optional<double> time_from_first_contact_s;  // unset if the plate was never touched
  std::optional<int> confidence{};                  // from 1; unset if not asked or not given
};
// A session's change of state.
struct SessionEventRow {
  std::int64_t session_id{};
  double t_s{};  // of a monotonic clock, from the session's begin
  std::string state;
  std::optional<int> number;  // of the trial; unset between trials
  std::string detail;
};
// An answer to one item of a questionnaire.
struct FormAnswerRow {
  std::int64_t session_id{};
  double t_s{};  // as a SessionEventRow's
  std::string form;
  std::string asked;  // session begin, session end, or the block that it came after
  std::string item;
  std::optional<std::string> answer;  // unset: left out
};
// An action of the operator during a session.
struct OperatorActionRow {
  std::int64_t session_id{};
  double t_s{};  // as a SessionEventRow's
  std::string action;
  std::optional<int> number;  // of the trial that it concerns
  std::string detail;
};
enum class GivenBy { participant, operator_of_session };
std::string to_text(GivenBy given_by);
GivenBy given_by_from(const std::string& text);

// Takes the place of a stored answer; that one stays in the store.
struct CorrectionRow {
  std::int64_t session_id{};
  int number{};  // of the trial
  std::string response;
  std::optional<bool> is_correct;
  GivenBy given_by{GivenBy::operator_of_session};
  int ordinal{};  // of the trial's corrections, from 1; the store counts
};
// The event of a trial whose trace was deliberately not kept.
inline constexpr const char* untraced_event = "untraced";
struct EventRow {
  double t_s{};  // from the first tick of the trial
  // contact, impact, late_impact, release, switch, untraced; setting: what the participant set the
  // axis of the last alternative to, first at 0 s where it started; scripted_taps: the trace has
  // the motion of the hand that tapped in the participant's place; of the masking noise, which is
  // played from before the first tick: masking (it was), and of the whole trial masking_underrun,
  // masking_cut (only where there were any) and masking_lost (the card plays no more); likewise
  // actuator (a vibration actuator rendered its share), actuator_jitter, actuator_rate_error,
  // actuator_underrun, actuator_limited and actuator_lost
  std::string kind;
  // impacts, scripted_taps: speed m/s; switch: position of the alternative; setting: the axis's
  // unit; masking: RMS in dB FS; masking_underrun, masking_cut: how many gaps, samples beyond full
  // scale; actuator: delay s; actuator_jitter: RMS s; actuator_rate_error: of the card, less 1;
  // actuator_underrun, actuator_limited: how many gaps, samples its limits changed; else 0
  double value{};
};
struct TraceChunk {
  std::int64_t first_tick{};
  std::int64_t ticks{};
  std::vector<std::byte> bytes;  // trace_codec.hpp
};
// What an actuator was given in a trial, period by period of its card, and what it followed from
// beside the trace: from these the samples can be rendered again (actuator_source.hpp).
struct ActuatorRow {
  double rate_hz{};
  double delay_s{};  // from a tick to its sound
  double full_scale_n{};
  double last_n{};                 // the sample before the first
  double mean_square_n2{};         // of the limiter, before the first
  std::int64_t ticks_lost{};       // of the loop, on their way to the card's thread
  std::int64_t dropped_periods{};  // the last ones
};
struct ActuatorChunk {
  std::int64_t first_period{};
  std::int64_t periods{};
  std::int64_t samples{};
  std::vector<std::byte> bytes;  // trace_codec.hpp
};
struct TickStatisticsRow {
  std::int64_t ticks{};
  std::int64_t late{};
  std::int64_t skipped{};
  std::int64_t saturated{};
  std::int64_t dropped_samples{};
  double lateness_p999_s{};  // 99.9 % of the ticks were no later, to 2 %
  double worst_lateness_s{};
  std::string fault;  // empty: none
};
// The end of a trial. An interrupted trial comes again; so does a repeated one, whose answer does
// not count; timed_out: no answer in time; skipped by the operator.
enum class TrialStatus { answered, interrupted, repeated, timed_out, skipped };
std::string to_text(TrialStatus status);
TrialStatus trial_status_from(const std::string& text);

struct TrialRow {
  std::int64_t session_id{};
  int number{};    // in the planned order, from 1
  int attempt{1};  // counts repetitions of an interrupted trial
  std::string block;
  std::string task;
  bool is_practice{};
  int repetition{};
  TrialStatus status{TrialStatus::answered};
  double duration_s{};
  bool is_catch{};          // there to see who attends
  bool is_of_real_plate{};  // not rendered: a plate that was mounted
};

// A trial with more of its ticks skipped is not quite what was designed.
inline constexpr double max_skipped_share = 0.01;

// The course of one participant's sessions. Trials are presentations, practice aside; values of the
// loop are over every stored trial.
struct ParticipantCourseRow {
  std::string participant_id;
  Mode mode{};
  std::optional<std::string> exclusion_reason;  // unset: not excluded
  int sessions{};
  int answered{};
  int interrupted{};
  int repeated{};  // their answers do not count
  int skipped{};
  int timed_out{};
  int given_up{};            // skipped or timed out, and not answered later
  int corrected{};           // answers, by the operator or the participant
  int corrected_to_right{};  // of these, that were wrong
  int catch_trials{};
  int catch_right{};
  int form_items{};           // of questionnaires that were shown
  int form_items_left_out{};  // of these
  std::int64_t ticks{};
  std::int64_t late{};
  std::int64_t skipped_ticks{};
  int incomplete_trials{};  // answered with more than max_skipped_share of their ticks skipped
  std::int64_t saturated{};
  std::int64_t dropped_samples{};
  double lateness_p999_s{};  // of the trial where it was largest
  double worst_lateness_s{};
  std::int64_t impacts{};
  std::int64_t late_impacts{};
  int masked_trials{};
  int stored_trials{};                   // of any block, however they ended
  std::optional<double> masking_low_db;  // RMS in dB FS; unset without masking noise
  std::optional<double> masking_high_db;
  std::int64_t masking_gaps{};
  std::int64_t masking_cut_samples{};  // beyond full scale
  int masking_lost{};                  // trials in which the card stopped
};

struct UnansweredTrial {
  int number{};
  std::string block;
  bool is_skipped{};  // else timed out
};

// A trial with all its data: stored atomically.
struct TrialRecord {
  TrialRow trial;
  std::vector<AlternativeRow> alternatives;
  std::optional<ResponseRow> response;
  std::vector<EventRow> events;
  std::vector<TraceChunk> trace;
  std::optional<ActuatorRow> actuator{};  // unset: none rendered, or it is not recorded
  std::vector<ActuatorChunk> actuator_chunks{};
  TickStatisticsRow statistics;
  std::vector<SessionEventRow> session_events;  // since the last trial
};

// An answered trial, as used by analysis.
struct AnswerRow {
  std::string participant_id;
  int participant_index{};  // within the mode
  int order_index{};
  Mode mode{};
  std::string block;
  std::string task;
  bool is_practice{};
  bool is_catch{};
  int number{};
  std::string stimulus;  // that was presented; empty if there were several to choose from
  std::string response;
  std::optional<bool> is_correct;
  double response_time_s{};  // NaN: not known; stored ones are
  std::int64_t ticks{};
  std::int64_t late{};
  std::int64_t skipped{};
  std::int64_t dropped_samples{};
  std::int64_t impacts{};
  std::int64_t late_impacts{};  // of these; up to 5 ms after a late tick
  std::int64_t trial_id{};      // ascends with time: a trial that was put off is answered later
  std::vector<AlternativeRow> alternatives{};         // by position; Store::answers leaves them out
  int repetition{};                                   // of its stimulus in the block, from 1
  std::optional<double> time_from_first_contact_s{};  // unset if the plate was never touched
  std::optional<double> mean_impact_speed_m_s{};      // unset without impacts
  double contact_s{};                                 // in contact, of the whole trial
  std::optional<double> first_setting{};              // where an adjustment started
  std::optional<int> confidence{};                    // from 1; unset if not asked or not given
  std::optional<int> track{};  // of its block's procedures, from 1; follows from all answers
  int place_in_block{};        // as planned, from 0; follows from the order of the session's blocks
};

// The answers given in a block by all participants of a mode whose answers are reported.
struct BlockCourseRow {
  std::set<std::string> participants{};  // who answered at least one of its trials
  int answered{};
  int masked{};  // of these; with masking noise
};

// The time and number of visits to each alternative in trials with several.
struct VisitRow {
  std::string participant_id;
  std::string block;
  std::string stimulus;
  int visits{};
  double dwell_s{};
};
}  // namespace tapstudy::results
