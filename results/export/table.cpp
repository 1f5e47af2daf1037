#include "results/export/table.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>
namespace tapstudy::results {
Table table_of(std::string name, std::string description, std::vector<Column> columns,
               std::vector<Row> rows) {
  return {std::move(name), std::move(description), std::move(columns),
          [kept = std::move(rows)](const RowSink& sink) { std::ranges::for_each(kept, sink); }};
}

namespace {
using enum CellType;

std::vector<Column> columns_of_context() {
  return {
      {"trial_id", integer, "", "Trial as presented, unique in the study; ascends with time"},
      {"session_id", integer, "", "Session, unique in the study"},
      {"participant_id", text, "", "Participant, unique in the study"},
      {"participant_index", integer, "", "Participant's number within the mode, from 0"},
      {"order_index", integer, "", "Which of the balanced orders the participant got, from 0"},
      {"group_name", text, "", "Group of participants that the participant is in"},
      {"group_assignment", text, "",
       "balanced (by the participant's order_index), or given by the operator"},
      {"planned_session", text, "", "Which of the protocol's sessions it is"},
      {"mode", text, "", "Who took part: real, pilot (a rehearsal) or simulated"},
      {"is_excluded", boolean, "", "The operator excluded the participant from the analysis"},
      {"exclusion_reason", text, "", "Why, in the operator's words; missing if not excluded"},
      {"block", text, "", "Block of the protocol"},
      {"task", text, "", "Task of the block"},
      {"number", integer, "",
       "Number of the trial in the participant's order, from 1; missing between trials"},
      {"attempt", integer, "", "1, and one more each time that the trial was presented again"},
      {"track", integer, "", "Which of the block's procedures chose the level, from 1 as listed"},
      {"level", real, "",
       "How far the comparison lies from its standard, as the procedure counts: a fraction of it, "
       "or in the axis's unit"},
      {"is_reversal", boolean, "", "The staircase turned with this answer"},
      {"repetition", integer, "", "Repetition of the stimulus within its block, from 1"},
      {"is_practice", boolean, "", "Practice: not to be analysed with the study's trials"},
      {"is_catch", boolean, "", "Catch trial, there to see who attends"},
      {"presented", text, "", "virtual (rendered by the device) or real (a plate was mounted)"},
      {"status", text, "",
       "answered; interrupted by a fault or a stop; repeated (its answer does not count); "
       "timed_out; skipped by the operator"},
      {"stimulus", text, "", "Name of the stimulus; in a trial missing if there were several"},
      {"alternatives", text, "",
       "All that was presented, in the order of their labels: NAME (AXIS=VALUE, …), separated by "
       "semicolons; * marks a comparison, what stands beside it is the standard"},
  };
}

std::vector<Column> columns_of_answers() {
  return {
      {"response", text, "",
       "Answer as the task stores it; see response_meanings. Where a row is an answer, as it was "
       "given; where it is a trial, with corrections"},
      {"is_correct", boolean, "", "Whether it is right; missing where no answer is right"},
      {"is_corrected", boolean, "", "The answer was corrected after it had been given"},
      {"first_response", text, "", "The answer as first given"},
      {"first_is_correct", boolean, "", "Whether the answer as first given is right"},
      {"given_by", text, "", "participant, or operator (a correction)"},
      {"response_meaning", text, "", "What participants took the answer to mean: its label"},
      {"confidence", integer, "", "Rated confidence from 1; missing if not asked or not given"},
      {"response_time_s", real, "s", "From the first tick of the trial to the answer"},
      {"time_from_first_contact_s", real, "s",
       "From the first contact to the answer; missing if nothing was touched"},
      {"response_id", integer, "", "Answer, unique in the study; ascends with time"},
      {"supersedes", integer, "", "response_id of the answer that this one corrects"},
      {"is_correction", boolean, "", "The answer takes the place of an earlier one"},
      {"is_current", boolean, "", "No correction took its place: this answer counts"},
  };
}

std::vector<Column> columns_of_conduct() {
  return {
      {"duration_s", real, "s", "From the first to the last tick of the trial"},
      {"first_contact_s", real, "s", "From the first tick of the trial to the first contact"},
      {"contacts", integer, "", "Contacts with what was presented"},
      {"impacts", integer, "", "Contacts that excited the plate's vibration"},
      {"late_impacts", integer, "", "Impacts up to 5 ms after a late tick: speed uncertain"},
      {"max_impact_speed_m_s", real, "m/s", "Fastest impact of the trial"},
      {"ticks", integer, "", "Ticks of the haptic loop during the trial"},
      {"late_ticks", integer, "", "Ticks that began more than half a period late"},
      {"skipped_ticks", integer, "", "Ticks that were left out because they had been missed"},
      {"saturated_ticks", integer, "", "Ticks in which the limiter changed the force"},
      {"dropped_samples", integer, "", "Samples of the trace that were lost; 0 unless stated"},
      {"lateness_p999_s", real, "s", "99.9 % of the ticks began no later than this, to 2 %"},
      {"worst_lateness_s", real, "s", "Lateness of the latest tick"},
      {"fault", text, "", "Fault that ended the trial; empty: none"},
      {"t_s", real, "s",
       "Time of the event: from the first tick of the trial; of session events, questionnaires and"
       " operator actions from the start of the session"},
      {"kind", text, "",
       "contact, impact, late_impact, release, switch (to an alternative), setting (of the "
       "adjusted alternative), interval (its go signal), interval_end, interval_replay (of all "
       "intervals), scripted_taps (a simulated hand taps in the participant's place, and its "
       "motion "
       "is in the trace), masking (noise is played), masking_underrun, masking_cut, masking_lost, "
       "actuator (a vibration actuator renders its share), actuator_jitter, actuator_rate_error, "
       "actuator_underrun, actuator_limited, "
       "actuator_lost, "
       "untraced (no trace was kept)"},
      {"value", real, "",
       "impact, late_impact, scripted_taps: speed in m/s; switch, interval, interval_end: position "
       "of "
       "the alternative; interval_replay: its number; setting: in the unit of the axis; masking: "
       "RMS "
       "level in dB of full scale; masking_underrun, masking_cut, actuator_underrun, "
       "actuator_limited: count; actuator: its delay in s; actuator_jitter: of the measured times "
       "of the card, RMS in s; actuator_rate_error: the rate of the card against the clock of the "
       "loop, less 1; otherwise 0"},
      {"position", integer, "", "Position of the alternative in its trial, from 0"},
      {"label", text, "", "What participants read; of an alternative its blind label"},
      {"is_comparison", boolean, "", "The comparison, not the standard"},
      {"visits", integer, "", "How often the alternative was switched to"},
      {"total_dwell_s", real, "s", "How long the alternative was presented, all visits together"},
      {"visit", integer, "", "Number of the visit in its trial, from 1"},
      {"begin_s", real, "s", "Start of the visit, from the first tick of the trial"},
      {"end_s", real, "s", "End of the visit: the next switch or the end of the trial"},
      {"dwell_s", real, "s", "Duration of the visit"},
  };
}

std::vector<Column> columns_of_sessions() {
  return {
      {"resumes", integer, "", "session_id of the session that this one continues"},
      {"started_utc", text, "", "When the session began, ISO 8601, UTC"},
      {"language", text, "", "Language that the participant read"},
      {"rate_hz", real, "Hz", "Rate of the haptic loop"},
      {"device", text, "", "Device by which forces were presented"},
      {"scheduler", text, "", "Real-time facilities that the system granted"},
      {"program_version", text, "", "Version of tapstudy"},
      {"git_hash", text, "", "Revision of tapstudy's sources"},
      {"compiler", text, "", "Compiler by which tapstudy was built"},
      {"seed", text, "", "Seed of the session, unsigned, 64 bits, decimal: to be read as text"},
      {"planned_order", text, "", "Order of the trials, a line each"},
      {"rig_text", text, "", "Rig file, whole"},
      {"protocol_text", text, "",
       "Protocol of the session, whole, where texts for people were not those of the study's first "
       "session"},
      {"doctor", text, "", "Performance of the machine before the session, JSON"},
      {"state", text, "", "State that the session entered"},
      {"detail", text, "",
       "Particulars: of an operator's action the note, the reason or the corrected answer"},
      {"action_id", integer, "", "Action of the operator, unique in the study"},
      {"action", text, "", "What the operator did"},
      {"form", text, "", "Questionnaire"},
      {"asked", text, "", "When: session begin, session end, or after the block named"},
      {"item", text, "", "Item of the questionnaire"},
      {"answer", text, "",
       "Answer: a step from 1, a mark from 0 (low) to 1 (high), a number, an option's name or text;"
       " missing if left out; as corrected"},
      {"amended", boolean, "", "The operator corrected the answer (operator_actions: when)"},
      {"amended_from", text, "", "The answer as given, where it was corrected; else missing"},
  };
}

std::vector<Column> columns_of_traces() {
  return {
      {"t_ns", integer, "ns", "Time of the tick, from the first tick of the trial"},
      {"position_x_m", real, "m", "Position of the hand, device frame: x right"},
      {"position_y_m", real, "m", "Position of the hand, device frame: y up"},
      {"position_z_m", real, "m", "Position of the hand, device frame: z towards the participant"},
      {"velocity_x_m_s", real, "m/s", "Velocity of the hand along x"},
      {"velocity_y_m_s", real, "m/s", "Velocity of the hand along y"},
      {"velocity_z_m_s", real, "m/s", "Velocity of the hand along z"},
      {"penetration_m", real, "m", "Depth of the hand below the surface of what is presented"},
      {"penalty_n", real, "N", "Penalty force along the outward normal, before the limiter"},
      {"vibration_n", real, "N",
       "Force of the plate's vibration along the normal, or what a coupled finger adds to "
       "penalty_n"},
      {"sinusoid_n", real, "N", "Force of the decaying sinusoid along the normal"},
      {"force_x_n", real, "N", "Commanded force, after the limiter, along x"},
      {"force_y_n", real, "N", "Commanded force, after the limiter, along y"},
      {"force_z_n", real, "N", "Commanded force, after the limiter, along z"},
      {"achieved_x_n", real, "N", "Force that the device reports along x; missing if it does not"},
      {"achieved_y_n", real, "N", "Force that the device reports along y; missing if it does not"},
      {"achieved_z_n", real, "N", "Force that the device reports along z; missing if it does not"},
      {"pose_residual_m", real, "m", "Disagreement of redundant position sensing"},
      {"closure_margin", real, "", "Of string-driven devices: wrench closure if above zero"},
      {"motor_voltage_v", real, "V", "Mean over the motors, where the device measures it"},
      {"alternative", integer, "", "Position of the alternative that was rendered, from 0"},
      {"touching", boolean, "", "In contact"},
      {"impact", boolean, "", "The plate was excited in this tick"},
      {"saturated", boolean, "", "The limiter changed the force"},
      {"fault_code", integer, "", "Fault in this tick; 0: none"},
      {"missed_replies", integer, "", "Replies of the device missing in a row"},
      {"late", boolean, "",
       "The tick began more than half a period late, or force rises again after a gap"},
  };
}

std::vector<Column> columns_of_actuators() {
  return {
      {"heard_s", real, "s",
       "Time at which the sample is heard, from the first tick of the trial, by the measured clock "
       "of the card: later than the tick that it renders by actuator.delay_s"},
      {"command_n", real, "N",
       "Force that the actuator was commanded, after its limits, its response undone"},
      {"is_heard", boolean, "",
       "The card took the sample; otherwise it had no room for it in time"},
  };
}

std::vector<Column> columns_of_stimuli() {
  return {
      {"plate", text, "", "Plate of the protocol"},
      {"material", text, "", "Material of the protocol"},
      {"technique", text, "", "Rendering technique"},
      {"youngs_modulus_pa", real, "Pa",
       "Young's modulus of the material; of an orthotropic one along its first axis"},
      {"density_kg_per_m3", real, "kg/m3", "Density of the material"},
      {"poissons_ratio", real, "", "Poisson's ratio of the material; none of an orthotropic one"},
      {"orthotropy", text, "",
       "Of an orthotropic material: Young's moduli along its axes 1 2 3, Poisson's ratios and "
       "shear moduli 12 13 23, and the turn of these axes in the plate frame"},
      {"size_x_m", real, "m", "Extent of the body along x, plate frame"},
      {"size_y_m", real, "m", "Extent of the body along y, plate frame"},
      {"size_z_m", real, "m", "Extent of the body along z: the thickness of a plate"},
      {"fixations", integer, "", "Places at which the plate is held"},
      {"in_contact", text, "",
       "Section `contacts` of the protocol that says what the plate touches"},
      {"varied_axes", text, "", "Axes along which members of the stimulus differ, by spaces"},
      {"mode_number", integer, "", "Mode of vibration, ascending in frequency, from 1"},
      {"frequency_hz", real, "Hz", "Undamped natural frequency of the mode"},
      {"damping_ratio", real, "", "Damping ratio of the mode; 1: critical"},
      {"question", text, "", "Question as the protocol states it"},
      {"item_kind", text, "", "likert, scale, number, single_choice, multiple_choice or text"},
      {"steps", integer, "", "Steps of a likert item"},
      {"low", text, "", "What the low end of the item means"},
      {"high", text, "", "What the high end of the item means"},
      {"options", text, "", "Options of a choice: name=label, a line each"},
  };
}
}  // namespace

const std::vector<Column>& all_known_columns() {
  static const std::vector<Column> all = [] {
    std::vector<Column> columns;
    for (const auto& part :
         {columns_of_context(), columns_of_answers(), columns_of_conduct(), columns_of_sessions(),
          columns_of_traces(), columns_of_actuators(), columns_of_stimuli()}) {
      columns.insert(columns.end(), part.begin(), part.end());
    }
    return columns;
  }();
  return all;
}

const Column& known_column(const std::string& name) {
  const auto found = std::ranges::find(all_known_columns(), name, &Column::name);
  if (found == all_known_columns().end()) {
    throw std::logic_error{"the data dictionary lacks column " + name};
  }
  return *found;
}

std::vector<Column> known_columns(const std::string& names) {
  std::vector<Column> columns;
  std::istringstream words{names};
  for (std::string name; words >> name;) {
    columns.push_back(known_column(name));
  }
  return columns;
}
}  // namespace tapstudy::results
