#include "results/store.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <thread>

#include "results/schema.hpp"
#include "results/store_error.hpp"
#include "results/trace_codec.hpp"
namespace tapstudy::results {
namespace {
namespace fs = std::filesystem;

std::string database_file(const std::string& directory) {
  return (fs::path{directory} / "study.db").string();
}

void make_directory(const std::string& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) {
    throw StoreError{fmt::format("{}: cannot be created: {}", directory, error.message())};
  }
}

std::int64_t pragma(Database& database, const std::string& name) {
  Statement statement{database, "PRAGMA " + name};
  statement.step();
  return statement.integer(0);
}

std::uint64_t seed_from(const std::string& text) {
  std::uint64_t seed{};
  std::from_chars(text.data(), text.data() + text.size(), seed);
  return seed;
}

// Changing the journal needs the file for oneself for a moment, and does not wait by itself.
void use_write_ahead_log(Database& database) {
  constexpr int attempts = 50;
  for (int attempt = 1;; ++attempt) {
    try {
      database.run(
          "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; "
          "PRAGMA foreign_keys = ON");
      return;
    } catch (const StoreError&) {
      if (attempt == attempts) {
        throw;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds{100});
    }
  }
}

constexpr const char* session_columns =
    "session_id, participant_id, participant_index, mode, seed, planned_order, resumes, rate_hz, "
    "rig_text, device, scheduler, program_version, git_hash, compiler, started_utc";

SessionRow session_from(Statement& row) {
  SessionRow session;
  session.id = row.integer(0);
  session.participant_id = row.text(1);
  session.participant_index = static_cast<int>(row.integer(2));
  session.mode = mode_from(row.text(3));
  session.seed = seed_from(row.text(4));
  session.planned_order = row.text(5);
  session.resumes = row.integer(6) != 0 ? std::optional{row.integer(6)} : std::nullopt;
  session.rate_hz = row.real(7);
  session.rig_text = row.text(8);
  session.device = row.text(9);
  session.scheduler = row.text(10);
  session.program_version = row.text(11);
  session.git_hash = row.text(12);
  session.compiler = row.text(13);
  session.started_utc = row.text(14);
  return session;
}
}  // namespace

Store Store::open_or_create(const std::string& directory, const StudyRow& study) {
  make_directory(directory);
  Store store{Database{database_file(directory), Database::Access::write}};
  if (!store.is_empty()) {
    store.check_schema();  // before anything in it is changed
  }
  use_write_ahead_log(store.database_);
  store.create_or_check(study);
  return store;
}

Store Store::open_existing(const std::string& directory) {
  std::error_code error;
  if (!fs::exists(database_file(directory), error)) {
    throw core::InvalidInput{fmt::format("{}: there is no study here (no study.db)", directory)};
  }
  Store store{Database{database_file(directory), Database::Access::read}};
  store.check_schema();
  return store;
}

Store::~Store() {
  if (!database_.is_open() || !database_.can_write()) {
    return;
  }
  try {
    database_.run("PRAGMA journal_mode = DELETE");
  } catch (const StoreError&) {  // NOLINT(bugprone-empty-catch): another process has it open
  }
}

bool Store::is_empty() {
  Statement tables{database_, "SELECT count(*) FROM sqlite_master"};
  tables.step();
  return tables.integer(0) == 0;
}

void Store::check_schema() {
  if (pragma(database_, "application_id") != application_id) {
    throw StoreError{database_.file() + ": is not a tapstudy database"};
  }
  const std::int64_t version = pragma(database_, "user_version");
  if (version != schema_version) {
    throw StoreError{fmt::format("{}: has schema {}, this program reads {}", database_.file(),
                                 version, schema_version)};
  }
}

// In one transaction, so that of two programs that start at once one creates and one finds.
void Store::create_or_check(const StudyRow& study) {
  Transaction all{database_};
  if (!is_empty()) {
    check_schema();
    const StudyRow present = this->study();
    if (present.protocol_sha256 != study.protocol_sha256) {
      throw core::InvalidInput{
          fmt::format("{}: holds the study of another protocol, '{}' (choose another --out; to "
                      "change a running "
                      "study, start a new one)",
                      database_.file(), present.title)};
    }
    return;
  }
  database_.run(schema_sql);
  database_.run(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", application_id,
                            schema_version));
  Statement{database_,
            "INSERT INTO study (id, title, protocol_file, protocol_text, protocol_sha256, "
            "created_utc) VALUES (1, ?, ?, ?, ?, ?)"}
      .bind(study.title)
      .bind(study.protocol_file)
      .bind(study.protocol_text)
      .bind(study.protocol_sha256)
      .bind(fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr))))
      .finish();
  all.commit();
}

StudyRow Store::study() {
  Statement row{database_,
                "SELECT title, protocol_file, protocol_text, protocol_sha256 FROM study"};
  if (!row.step()) {
    throw StoreError{database_.file() + ": the study's own row is missing"};
  }
  return {row.text(0), row.text(1), row.text(2), row.text(3)};
}

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
  Statement{database_,
            "INSERT INTO session (participant_id, seed, planned_order, resumes, rate_hz, "
            "rig_text, device, scheduler, program_version, git_hash, compiler, started_utc) "
            "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"}
      .bind(session.participant_id)
      .bind(std::to_string(session.seed))
      .bind(session.planned_order)
      .bind(session.resumes)
      .bind(session.rate_hz)
      .bind(session.rig_text)
      .bind(session.device)
      .bind(session.scheduler)
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
  Statement{database_, "INSERT INTO tick_statistics VALUES (?, ?, ?, ?, ?, ?, ?, ?)"}
      .bind(trial_id)
      .bind(statistics.ticks)
      .bind(statistics.late)
      .bind(statistics.skipped)
      .bind(statistics.saturated)
      .bind(statistics.dropped_samples)
      .bind(statistics.worst_lateness_s)
      .bind(statistics.fault)
      .finish();
}

std::vector<SessionRow> Store::sessions() {
  std::vector<SessionRow> sessions;
  Statement row{database_, fmt::format("SELECT {} FROM session JOIN participant "
                                       "USING (participant_id) ORDER BY session_id",
                                       session_columns)};
  while (row.step()) {
    sessions.push_back(session_from(row));
  }
  return sessions;
}

std::optional<SessionRow> Store::latest_session(const std::string& participant_id) {
  Statement row{database_, fmt::format("SELECT {} FROM session JOIN participant "
                                       "USING (participant_id) WHERE participant_id = ? "
                                       "ORDER BY session_id DESC LIMIT 1",
                                       session_columns)};
  row.bind(participant_id);
  return row.step() ? std::optional{session_from(row)} : std::nullopt;
}

std::vector<int> Store::answered_trials(const std::string& participant_id) {
  Statement row{database_,
                "SELECT number FROM trial JOIN session USING (session_id) "
                "WHERE participant_id = ? AND status = 'answered' ORDER BY number"};
  row.bind(participant_id);
  std::vector<int> numbers;
  while (row.step()) {
    numbers.push_back(static_cast<int>(row.integer(0)));
  }
  return numbers;
}

std::vector<AnswerRow> Store::answers() {
  Statement row{
      database_,
      "SELECT participant_id, mode, block, task, is_practice, number, "
      "  CASE task WHEN 'identification' THEN (SELECT stimulus FROM alternative "
      "    WHERE alternative.trial_id = trial.trial_id AND position = 0) ELSE '' END, "
      "  response, response_time_s, ticks, late, skipped, dropped_samples "
      "FROM trial JOIN session USING (session_id) JOIN response USING (trial_id) "
      "JOIN tick_statistics USING (trial_id) JOIN participant USING (participant_id) "
      "WHERE response_id NOT IN (SELECT supersedes FROM response WHERE supersedes IS NOT NULL) "
      "ORDER BY participant_index, number"};
  std::vector<AnswerRow> answers;
  while (row.step()) {
    answers.push_back({row.text(0), mode_from(row.text(1)), row.text(2), row.text(3),
                       row.integer(4) != 0, static_cast<int>(row.integer(5)), row.text(6),
                       row.text(7), row.real(8), row.integer(9), row.integer(10), row.integer(11),
                       row.integer(12)});
  }
  return answers;
}

// A visit lasts from the switch to an alternative to the next switch or the end of the trial.
std::vector<VisitRow> Store::visits() {
  Statement row{
      database_,
      "WITH visit AS (SELECT trial_id, t_s, CAST(value AS INTEGER) AS position, "
      "  lead(t_s) OVER (PARTITION BY trial_id ORDER BY t_s) AS until_s "
      "  FROM event WHERE kind = 'switch') "
      "SELECT participant_id, block, stimulus, count(*), "
      "  sum(coalesce(until_s, duration_s) - t_s) "
      "FROM visit JOIN trial USING (trial_id) JOIN session USING (session_id) "
      "JOIN participant USING (participant_id) JOIN alternative USING (trial_id, position) "
      "WHERE task = 'choice' AND status = 'answered' "
      "GROUP BY participant_index, block, stimulus ORDER BY participant_index, block, stimulus"};
  std::vector<VisitRow> visits;
  while (row.step()) {
    visits.push_back(
        {row.text(0), row.text(1), row.text(2), static_cast<int>(row.integer(3)), row.real(4)});
  }
  return visits;
}

std::vector<core::TraceSample> Store::trace(std::int64_t trial_id) {
  Statement row{database_,
                "SELECT ticks, bytes FROM trace_chunk WHERE trial_id = ? ORDER BY first_tick"};
  row.bind(trial_id);
  std::vector<core::TraceSample> samples;
  while (row.step()) {
    const auto chunk = decode_trace(row.bytes(1), static_cast<std::size_t>(row.integer(0)));
    samples.insert(samples.end(), chunk.begin(), chunk.end());
  }
  return samples;
}
}  // namespace tapstudy::results
