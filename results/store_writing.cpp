// What adds rows to a study.
#include <fmt/format.h>

#include "results/store.hpp"
#include "results/store_error.hpp"
#include "results/trace_codec.hpp"
namespace tapstudy::results {
int Store::index_of(const std::string& participant_id, Mode mode) {
  Statement row{database_,
                "SELECT participant_index, mode FROM participant WHERE participant_id = ?"};
  row.bind(participant_id);
  if (!row.step()) {
    Statement next{
        database_,
        "SELECT coalesce(max(participant_index) + 1, 0) FROM participant WHERE mode = ?"};
    next.bind(to_text(mode)).step();
    return static_cast<int>(next.integer(0));
  }
  if (row.text(1) != to_text(mode)) {
    throw core::InvalidInput{
        fmt::format("participant '{}' is in this study already, in {} sessions (choose another id)",
                    participant_id, row.text(1))};
  }
  return static_cast<int>(row.integer(0));
}

bool Store::has_sessions(const std::string& participant_id) {
  return latest_session(participant_id).has_value();
}

void Store::add_session(SessionRow& session) {
  Transaction all{database_};
  Statement{database_,
            "INSERT OR IGNORE INTO participant (participant_id, mode, participant_index) "
            "VALUES (?, ?, ?)"}
      .bind(session.participant_id)
      .bind(to_text(session.mode))
      .bind(session.participant_index)
      .finish();
  Statement{
      database_,
      "INSERT INTO session (participant_id, seed, planned_order, resumes, rate_hz, "
      "rig_text, device, scheduler, doctor, program_version, git_hash, compiler, started_utc) "
      "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"}
      .bind(session.participant_id)
      .bind(std::to_string(session.seed))
      .bind(session.planned_order)
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

void Store::add_trial(const TrialRecord& record) {
  Transaction whole_trial{database_};
  const TrialRow& trial = record.trial;
  if (record.response) {
    check_not_answered(trial);
  }
  Statement{database_,
            "INSERT INTO trial (session_id, number, attempt, block, task, is_practice, "
            "repetition, status, duration_s) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)"}
      .bind(trial.session_id)
      .bind(trial.number)
      .bind(trial.attempt)
      .bind(trial.block)
      .bind(trial.task)
      .bind(trial.is_practice)
      .bind(trial.repetition)
      .bind(trial.status)
      .bind(trial.duration_s)
      .finish();
  add_details(database_.last_row_id(), record);
  whole_trial.commit();
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

void Store::add_details(std::int64_t trial_id, const TrialRecord& record) {
  for (const AlternativeRow& alternative : record.alternatives) {
    Statement{database_, "INSERT INTO alternative VALUES (?, ?, ?, ?)"}
        .bind(trial_id)
        .bind(alternative.position)
        .bind(alternative.label)
        .bind(alternative.stimulus)
        .finish();
  }
  if (record.response) {
    Statement{database_,
              "INSERT INTO response (trial_id, response, is_correct, response_time_s, "
              "time_from_first_contact_s) VALUES (?, ?, ?, ?, ?)"}
        .bind(trial_id)
        .bind(record.response->response)
        .bind(record.response->is_correct)
        .bind(record.response->response_time_s)
        .bind(record.response->time_from_first_contact_s)
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
