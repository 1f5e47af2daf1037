// Store: adding rows to a study.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "results/store/store.hpp"
#include "results/store_error.hpp"
#include "results/traces/trace_codec.hpp"
namespace tapstudy::results {
namespace fs = std::filesystem;
using namespace std::string_literals;
namespace {
// Selects the participants whose last session the operator ended.
constexpr const char* ended_by_operator =
    "SELECT participant_id FROM session AS last WHERE session_id = "
    "  (SELECT max(session_id) FROM session WHERE participant_id = last.participant_id) "
    " AND EXISTS (SELECT 1 FROM operator_action WHERE session_id = last.session_id "
    "             AND action = 'end')";
}  // namespace

Store::Place Store::place_of(const std::string& participant_id, Mode mode,
                             const OtherParticipants& others,
                             const std::function<bool(int order_index)>& may_have) {
  Statement row{
      database_,
      "SELECT participant_index, order_index, mode FROM participant WHERE participant_id = ?"};
  row.bind(participant_id);
  if (!row.step()) {
    const std::map<int, std::string> used = orders_used_beside(participant_id, mode, others);
    int free = 0;
    while (used.contains(free) || (may_have && !may_have(free))) {
      ++free;
    }
    return {next_participant_index(mode), free};
  }
  if (row.text(2) != to_text(mode)) {
    throw core::InvalidInput{
        fmt::format("participant '{}' is in this study already, in {} sessions (choose another id)",
                    participant_id, row.text(2))};
  }
  return {row.small_integer(0), row.small_integer(1)};
}

int Store::next_participant_index(Mode mode) {
  Statement next{database_,
                 "SELECT coalesce(max(participant_index) + 1, 0) FROM participant WHERE mode = ?"};
  next.bind(to_text(mode)).step();
  return static_cast<int>(next.integer(0));
}

// Used by who has answered what counts, unless the operator ended their last session before its
// end.
std::map<int, std::string> Store::orders_used_beside(const std::string& participant_id, Mode mode,
                                                     const OtherParticipants& others) {
  const std::map<std::string, std::string> excluded = excluded_participants();
  Statement row{database_,
                "SELECT participant_id, order_index, participant_id IN "
                "  (SELECT participant_id FROM trial JOIN session USING (session_id) "
                "   WHERE status = 'answered' AND NOT is_practice), participant_id IN ("s +
                    ended_by_operator +
                    ") FROM participant WHERE mode = ? AND participant_id <> ?"};
  row.bind(to_text(mode)).bind(participant_id);
  std::map<int, std::string> used;
  while (row.step()) {
    const std::string other = row.text(0);
    const bool has_answered = row.flag(2);
    const bool was_ended = row.flag(3);
    const bool keeps_order = (has_answered && !(was_ended && others.has_trials_left(other))) ||
                             others.is_in_session(other);
    if (keeps_order && !excluded.contains(other)) {
      used.emplace(row.small_integer(1), other);
    }
  }
  return used;
}

// Once they are committed: what is rolled back must not be in the journal.
void Store::journal_sessions() {
  if (journal_ && !database_.is_in_transaction()) {
    journal(session_ids(), {});
  }
}

void Store::in_one_transaction(const std::function<void()>& act) {
  {
    Transaction all{database_};
    act();
    all.commit();
  }
  journal_sessions();
}

namespace {
bool counts_any(Database& database, const char* select_count) {
  Statement row{database, select_count};
  row.step();
  return row.integer(0) > 0;
}
}  // namespace

bool Store::has_groups() {
  return has_columns_of_groups() &&
         counts_any(database_, "SELECT count(group_name) FROM participant");
}

bool Store::has_planned_sessions() {
  return has_columns_of_planned_sessions() &&
         counts_any(database_, "SELECT count(planned_session) FROM session");
}

bool Store::has_changed_texts() {
  return has_columns_of_planned_sessions() &&
         counts_any(database_, "SELECT count(protocol_text) FROM session");
}

void Store::add_participant(const SessionRow& session) {
  const bool has_columns = has_columns_of_groups();
  if (session.group && !has_columns) {
    throw StoreError{database_.file() + ": is of a study without groups"};
  }
  Statement row{database_,
                fmt::format("INSERT INTO participant (participant_id, mode, participant_index, "
                            "order_index{}) VALUES (?, ?, ?, ?{}) "
                            "ON CONFLICT (participant_id) DO NOTHING",
                            has_columns ? ", group_name, group_assignment" : "",
                            has_columns ? ", ?, ?" : "")};
  row.bind(session.participant_id)
      .bind(to_text(session.mode))
      .bind(session.participant_index)
      .bind(session.order_index);
  if (has_columns && session.group) {
    row.bind(session.group->name).bind(assignment_of(*session.group));
  } else if (has_columns) {
    row.bind_null().bind_null();
  }
  row.finish();
}

void Store::add_session(SessionRow& session) {
  Transaction all{database_};
  add_participant(session);
  const bool has_columns = has_columns_of_planned_sessions();
  if (changed_protocol_text_) {
    session.protocol_text = changed_protocol_text_;
  }
  if (!has_columns && (session.planned_session || session.protocol_text)) {
    throw StoreError{database_.file() + ": is of a study without planned sessions"};
  }
  Statement row{
      database_,
      fmt::format(
          "INSERT INTO session (participant_id, seed, planned_order, language, resumes, rate_hz, "
          "rig_text, device, scheduler, doctor, program_version, git_hash, compiler, "
          "started_utc{}) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?{})",
          has_columns ? ", planned_session, protocol_text" : "", has_columns ? ", ?, ?" : "")};
  row.bind(session.participant_id)
      .bind(std::to_string(session.seed))
      .bind(session.planned_order)
      .bind(session.language)
      .bind(session.resumes)
      .bind(session.rate_hz)
      .bind(session.rig_text)
      .bind(session.device)
      .bind(session.scheduler)
      .bind(session.doctor)
      .bind(session.program_version)
      .bind(session.git_hash)
      .bind(session.compiler)
      .bind(session.started_utc);
  if (has_columns) {
    row.bind(session.planned_session).bind(session.protocol_text);
  }
  row.finish();
  session.id = database_.last_row_id();
  all.commit();
  journal_sessions();
}

SaveOutcome Store::add_trial(const TrialRecord& record) {
  if (!confirms_) {
    add_to_batch(record);
    return SaveOutcome::in_one_file;  // resume_sync makes it so
  }
  const TrialRow& trial = record.trial;
  const std::array<std::int64_t, 3> key{trial.session_id, trial.number, trial.attempt};
  if (unconfirmed_ != key) {
    insert_trial(record);
    unconfirmed_ = key;
  }
  bool is_in_one_file = true;
  if (journal_) {
    is_in_one_file = database_.checkpoint();
    check_is_in_place(trial);
  }
  add_to_journal(record);
  unconfirmed_.reset();
  return is_in_one_file ? SaveOutcome::in_one_file : SaveOutcome::partly_in_log;
}

namespace {
// Whether the journal records it.
bool is_answered(const TrialRecord& record) {
  return record.response && record.trial.status == TrialStatus::answered;
}
}  // namespace

// A transaction a trial would cost more than the rows of one without a trace.
void Store::add_to_batch(const TrialRecord& record) {
  constexpr int most_trials = 40;
  in_batch([&] {
    if (!std::exchange(batch_.is_open, true)) {
      database_.run("BEGIN IMMEDIATE");
    }
    insert_trial(record);
  });
  if (is_answered(record)) {
    batch_.answers.push_back({record.trial, record.alternatives, *record.response});
  }
  if (++batch_.trials == most_trials || !record.trace.empty()) {
    commit_batch();
  }
}

// Where a write fails for want of space, SQLite rolls the whole transaction back by itself: nothing
// is added after that.
void Store::in_batch(const std::function<void()>& act) {
  if (!batch_failure_.empty()) {
    throw StoreError{batch_failure_};
  }
  try {
    act();
  } catch (const StoreError& error) {
    if (!database_.is_in_transaction()) {
      batch_failure_ = error.what();
    }
    throw;
  }
}

// What is rolled back must not be in the journal.
void Store::commit_batch() {
  if (!batch_.is_open) {
    return;
  }
  in_batch([&] { database_.run("COMMIT"); });
  const Batch batch = std::exchange(batch_, {});
  if (!journal_ || batch.answers.empty()) {
    return;
  }
  std::set<std::int64_t> ids;
  for (const JournalledAnswer& answer : batch.answers) {
    ids.insert(answer.trial.session_id);
  }
  journal(ids, {.answers = batch.answers});
}

void Store::add_to_journal(const TrialRecord& record) {
  journal_failed_calls();
  if (journal_ && is_answered(record)) {
    journal({record.trial.session_id},
            {.answers = {{record.trial, record.alternatives, *record.response}}});
  }
}

void Store::insert_trial(const TrialRecord& record) {
  Transaction whole_trial{database_};
  const TrialRow& trial = record.trial;
  if (record.response) {
    check_not_answered(trial);
  }
  Statement{database_,
            "INSERT INTO trial (session_id, number, attempt, block, task, is_practice, "
            "is_catch, presented, repetition, status, duration_s) "
            "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"}
      .bind(trial.session_id)
      .bind(trial.number)
      .bind(trial.attempt)
      .bind(trial.block)
      .bind(trial.task)
      .bind(trial.is_practice)
      .bind(trial.is_catch)
      .bind(std::string{trial.is_of_real_plate ? "real" : "virtual"})
      .bind(trial.repetition)
      .bind(to_text(trial.status))
      .bind(trial.duration_s)
      .finish();
  add_details(database_.last_row_id(), record);
  add_session_events(record.session_events);
  whole_trial.commit();
}

void Store::add_session_events(const std::vector<SessionEventRow>& events) {
  Transaction all{database_};
  for (const SessionEventRow& event : events) {
    Statement{database_, "INSERT INTO session_event VALUES (?, ?, ?, ?, ?)"}
        .bind(event.session_id)
        .bind(event.t_s)
        .bind(event.state)
        .bind(event.number)
        .bind(event.detail)
        .finish();
  }
  all.commit();
}

void Store::check_not_answered(const TrialRow& trial) {
  Statement row{database_,
                "SELECT participant_id FROM trial JOIN session USING (session_id) "
                "WHERE number = ? AND status = 'answered' AND participant_id = "
                "(SELECT participant_id FROM session WHERE session_id = ?)"};
  row.bind(trial.number).bind(trial.session_id);
  if (row.step()) {
    throw StoreError{
        fmt::format("{}: participant '{}' has answered trial {} already (is another "
                    "session of the same participant running?)",
                    database_.file(), row.text(0), trial.number)};
  }
}

void Store::add_alternatives(std::int64_t trial_id,
                             const std::vector<AlternativeRow>& alternatives) {
  for (const AlternativeRow& alternative : alternatives) {
    Statement{database_, "INSERT INTO alternative VALUES (?, ?, ?, ?, ?)"}
        .bind(trial_id)
        .bind(alternative.position)
        .bind(alternative.label)
        .bind(alternative.stimulus)
        .bind(alternative.is_comparison)
        .finish();
    for (const auto& [axis, value] : alternative.axis_values) {
      Statement{database_, "INSERT INTO axis_value VALUES (?, ?, ?, ?)"}
          .bind(trial_id)
          .bind(alternative.position)
          .bind(axis)
          .bind(value)
          .finish();
    }
  }
}

// A store that was begun before there were actuators goes on without.
void Store::add_actuator(std::int64_t trial_id, const TrialRecord& record) {
  if (!record.actuator || !has_tables_of_actuators()) {
    return;
  }
  const ActuatorRow& actuator = *record.actuator;
  Statement{database_, "INSERT INTO actuator VALUES (?, ?, ?, ?, ?, ?, ?, ?)"}
      .bind(trial_id)
      .bind(actuator.rate_hz)
      .bind(actuator.delay_s)
      .bind(actuator.full_scale_n)
      .bind(actuator.last_n)
      .bind(actuator.mean_square_n2)
      .bind(actuator.ticks_lost)
      .bind(actuator.dropped_periods)
      .finish();
  for (const ActuatorChunk& chunk : record.actuator_chunks) {
    Statement{database_, "INSERT INTO actuator_chunk VALUES (?, ?, ?, ?, ?, ?)"}
        .bind(trial_id)
        .bind(chunk.first_period)
        .bind(chunk.periods)
        .bind(chunk.samples)
        .bind(std::string{actuator_codec})
        .bind(std::span<const std::byte>{chunk.bytes})
        .finish();
  }
}

void Store::add_details(std::int64_t trial_id, const TrialRecord& record) {
  add_alternatives(trial_id, record.alternatives);
  if (record.response) {
    Statement{database_,
              "INSERT INTO response (trial_id, response, is_correct, response_time_s, "
              "time_from_first_contact_s, confidence, given_by) "
              "VALUES (?, ?, ?, ?, ?, ?, 'participant')"}
        .bind(trial_id)
        .bind(record.response->response)
        .bind(record.response->is_correct)
        .bind(record.response->response_time_s)
        .bind(record.response->time_from_first_contact_s)
        .bind(record.response->confidence)
        .finish();
  }
  for (const EventRow& event : record.events) {
    Statement{database_, "INSERT INTO event VALUES (?, ?, ?, ?)"}
        .bind(trial_id)
        .bind(event.t_s)
        .bind(event.kind)
        .bind(event.value)
        .finish();
  }
  for (const TraceChunk& chunk : record.trace) {
    Statement{database_, "INSERT INTO trace_chunk VALUES (?, ?, ?, ?, ?)"}
        .bind(trial_id)
        .bind(chunk.first_tick)
        .bind(chunk.ticks)
        .bind(std::string{trace_codec})
        .bind(std::span<const std::byte>{chunk.bytes})
        .finish();
  }
  add_actuator(trial_id, record);
  const TickStatisticsRow& statistics = record.statistics;
  Statement{database_, "INSERT INTO tick_statistics VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)"}
      .bind(trial_id)
      .bind(statistics.ticks)
      .bind(statistics.late)
      .bind(statistics.skipped)
      .bind(statistics.saturated)
      .bind(statistics.dropped_samples)
      .bind(statistics.lateness_p999_s)
      .bind(statistics.worst_lateness_s)
      .bind(statistics.fault)
      .finish();
}

// Answers to questionnaires.
void Store::insert_form_answer(const FormAnswerRow& answer) {
  Statement{database_, "INSERT INTO form_answer VALUES (?, ?, ?, ?, ?, ?)"}
      .bind(answer.session_id)
      .bind(answer.t_s)
      .bind(answer.form)
      .bind(answer.asked)
      .bind(answer.item)
      .bind(answer.answer)
      .finish();
}

void Store::add_form(const std::vector<FormAnswerRow>& answers) {
  if (answers.empty()) {
    return;
  }
  add_and_journal({.form_answers = answers}, answers.front().session_id,
                  [&](JournalEntries& /*entries*/) {
                    for (const FormAnswerRow& answer : answers) {
                      insert_form_answer(answer);
                    }
                  });
}

namespace {
std::vector<FormAnswerRow> form_answers(Statement row) {
  std::vector<FormAnswerRow> answers;
  while (row.step()) {
    answers.push_back(
        {row.integer(0), row.real(1), row.text(2), row.text(3), row.text(4), row.optional_text(5)});
  }
  return answers;
}
}  // namespace

std::vector<FormAnswerRow> Store::form_answers_of(const std::string& participant_id) {
  Statement row{database_,
                "SELECT session_id, t_s, form, asked, item, answer FROM form_answer "
                "JOIN session USING (session_id) WHERE participant_id = ? "
                "ORDER BY form_answer.rowid"};
  row.bind(participant_id);
  return form_answers(std::move(row));
}

std::vector<FormAnswerRow> Store::forms_for_journal() {
  return form_answers({database_,
                       "SELECT session_id, t_s, form, asked, item, answer FROM form_answer "
                       "ORDER BY rowid"});
}

// Appends what of it the journal lacks.
void Store::journal(const std::set<std::int64_t>& session_ids_of_entries,
                    const JournalEntries& entries) {
  const auto of_study = [this] { return study(); };
  std::vector<SessionRow> new_sessions;
  for (const std::int64_t id : session_ids_of_entries) {
    if (!journal_->holds_session(id)) {
      new_sessions.push_back(session_of(id));
    }
  }
  if (!journal_->complete(of_study, new_sessions, entries)) {
    journal_->complete(of_study, sessions(), entries_for_journal());
  }
}

void Store::insert_action(const OperatorActionRow& action) {
  Statement{database_,
            "INSERT INTO operator_action (session_id, t_s, action, number, detail) "
            "VALUES (?, ?, ?, ?, ?)"}
      .bind(action.session_id)
      .bind(action.t_s)
      .bind(action.action)
      .bind(action.number)
      .bind(action.detail)
      .finish();
}

// Rows that are in the database, but whose journalling failed, are journalled by the next call of
// any kind, the last time when the store is closed.
void Store::journal_failed_calls() {
  for (FailedCall& one : failed_calls_) {
    if (!one.is_journalled) {
      if (journal_) {
        journal({one.session_id}, one.entries);
      }
      one.is_journalled = true;
    }
  }
}

// The call that is made again for rows that are in the database finds them and inserts nothing.
void Store::add_and_journal(JournalEntries entries, std::int64_t session_id,
                            const std::function<void(JournalEntries&)>& insert) {
  commit_batch();
  const std::vector<std::string> what = to_lines(entries);
  if (std::ranges::find(failed_calls_, what, &FailedCall::lines) == failed_calls_.end()) {
    Transaction all{database_};
    insert(entries);
    all.commit();
    failed_calls_.push_back({what, std::move(entries), session_id});
  }
  if (journal_) {
    check_has_not_moved();
  }
  journal_failed_calls();
  std::erase_if(failed_calls_, [&](const FailedCall& one) { return one.lines == what; });
}

void Store::add_operator_action(const OperatorActionRow& action) {
  add_and_journal({.actions = {action}}, action.session_id,
                  [&](JournalEntries& /*entries*/) { insert_action(action); });
}

// The times are those of the answer that the participant gave.
int Store::insert_correction(const CorrectionRow& correction) {
  Statement{database_,
            "INSERT INTO response (trial_id, response, is_correct, response_time_s, "
            "time_from_first_contact_s, confidence, supersedes, given_by) "
            "SELECT trial_id, ?, ?, response_time_s, time_from_first_contact_s, confidence, "
            "response_id, ? FROM current_response JOIN trial USING (trial_id) "
            "WHERE session_id = ? AND number = ? AND status = 'answered'"}
      .bind(correction.response)
      .bind(correction.is_correct)
      .bind(to_text(correction.given_by))
      .bind(correction.session_id)
      .bind(correction.number)
      .finish();
  Statement changes{database_, "SELECT changes()"};
  changes.step();
  if (changes.integer(0) != 1) {
    throw StoreError{fmt::format("{}: trial {} has no answer that could be corrected",
                                 database_.file(), correction.number)};
  }
  Statement count{database_,
                  "SELECT count(supersedes) FROM response JOIN trial USING (trial_id) "
                  "WHERE session_id = ? AND number = ?"};
  count.bind(correction.session_id).bind(correction.number).step();
  return static_cast<int>(count.integer(0));
}

void Store::add_correction(const CorrectionRow& correction, const OperatorActionRow& action) {
  add_and_journal({.corrections = {correction}, .actions = {action}}, correction.session_id,
                  [&](JournalEntries& entries) {
                    entries.corrections.front().ordinal = insert_correction(correction);
                    insert_action(action);
                  });
}

std::map<std::string, std::string> Store::excluded_participants() {
  Statement row{database_, "SELECT participant_id, exclusion_reason FROM excluded_participant"};
  std::map<std::string, std::string> excluded;
  while (row.step()) {
    excluded[row.text(0)] = row.text(1);
  }
  return excluded;
}

JournalEntries Store::entries_for_journal() {
  return {answers_for_journal(), corrections_for_journal(), actions_for_journal(),
          forms_for_journal()};
}

std::vector<CorrectionRow> Store::corrections_for_journal() {
  Statement row{database_,
                "SELECT session_id, number, response, is_correct, given_by, "
                "row_number() OVER (PARTITION BY trial_id ORDER BY response_id) FROM response "
                "JOIN trial USING (trial_id) WHERE supersedes IS NOT NULL ORDER BY response_id"};
  std::vector<CorrectionRow> corrections;
  while (row.step()) {
    corrections.push_back({row.integer(0), row.small_integer(1), row.text(2), row.optional_flag(3),
                           given_by_from(row.text(4)), row.small_integer(5)});
  }
  return corrections;
}

std::vector<OperatorActionRow> Store::actions_for_journal() {
  Statement row{database_,
                "SELECT session_id, t_s, action, number, detail FROM operator_action "
                "ORDER BY action_id"};
  std::vector<OperatorActionRow> actions;
  while (row.step()) {
    actions.push_back({row.integer(0), row.real(1), row.text(2), row.optional_int(3), row.text(4)});
  }
  return actions;
}
}  // namespace tapstudy::results
