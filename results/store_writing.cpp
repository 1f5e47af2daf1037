// What adds rows to a study.
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <set>

#include "results/store.hpp"
#include "results/store_error.hpp"
#include "results/trace_codec.hpp"
namespace tapstudy::results {
namespace fs = std::filesystem;
using namespace std::string_literals;
namespace {
// Whose last session the operator ended.
constexpr const char* ended_by_operator =
    "SELECT participant_id FROM session AS last WHERE session_id = "
    "  (SELECT max(session_id) FROM session WHERE participant_id = last.participant_id) "
    " AND EXISTS (SELECT 1 FROM operator_action WHERE session_id = last.session_id "
    "             AND action = 'end')";
}  // namespace

Store::Place Store::place_of(const std::string& participant_id, Mode mode, const Others& others) {
  Statement row{
      database_,
      "SELECT participant_index, order_index, mode FROM participant WHERE participant_id = ?"};
  row.bind(participant_id);
  if (!row.step()) {
    return {next_participant_index(mode), free_order_index(mode, others)};
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
int Store::free_order_index(Mode mode, const Others& others) {
  const std::map<std::string, std::string> excluded = excluded_participants();
  Statement row{database_,
                "SELECT participant_id, order_index, participant_id IN "
                "  (SELECT participant_id FROM trial JOIN session USING (session_id) "
                "   WHERE status = 'answered' AND NOT is_practice), participant_id IN ("s +
                    ended_by_operator + ") FROM participant WHERE mode = ?"};
  row.bind(to_text(mode));
  std::set<int> used;
  while (row.step()) {
    const std::string participant_id = row.text(0);
    const bool has_answered = row.flag(2);
    const bool was_ended = row.flag(3);
    const bool keeps_order =
        (has_answered && !(was_ended && others.has_trials_left(participant_id))) ||
        others.is_in_session(participant_id);
    if (keeps_order && !excluded.contains(participant_id)) {
      used.insert(row.small_integer(1));
    }
  }
  int free = 0;
  while (used.contains(free)) {
    ++free;
  }
  return free;
}

bool Store::has_sessions(const std::string& participant_id) {
  return latest_session(participant_id).has_value();
}

void Store::in_one_transaction(const std::function<void()>& act) {
  Transaction all{database_};
  act();
  all.commit();
}

void Store::add_session(SessionRow& session) {
  Transaction all{database_};
  Statement{database_,
            "INSERT INTO participant (participant_id, mode, participant_index, order_index) "
            "VALUES (?, ?, ?, ?) "
            "ON CONFLICT (participant_id) DO NOTHING"}
      .bind(session.participant_id)
      .bind(to_text(session.mode))
      .bind(session.participant_index)
      .bind(session.order_index)
      .finish();
  Statement{
      database_,
      "INSERT INTO session (participant_id, seed, planned_order, language, resumes, rate_hz, "
      "rig_text, device, scheduler, doctor, program_version, git_hash, compiler, started_utc) "
      "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"}
      .bind(session.participant_id)
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
      .bind(session.started_utc)
      .finish();
  session.id = database_.last_row_id();
  all.commit();
}

SaveOutcome Store::add_trial(const TrialRecord& record) {
  const TrialRow& trial = record.trial;
  const std::array<std::int64_t, 3> key{trial.session_id, trial.number, trial.attempt};
  if (unconfirmed_ != key) {
    insert_trial(record);
    unconfirmed_ = key;
  }
  bool is_in_one_file = true;
  if (journal_ && confirms_) {
    is_in_one_file = database_.checkpoint();
    check_is_in_place(trial);
  }
  add_to_journal(record);
  unconfirmed_.reset();
  return is_in_one_file ? SaveOutcome::in_one_file : SaveOutcome::partly_in_log;
}

void Store::add_to_journal(const TrialRecord& record) {
  if (record.response && record.trial.status == TrialStatus::answered) {
    journal({.answers = {{record.trial, record.alternatives, *record.response}}},
            record.trial.session_id);
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
}  // namespace tapstudy::results
