// Store: reading a study's rows back.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "core/files/output_files.hpp"
#include "core/text/plain_text.hpp"
#include "results/compression.hpp"
#include "results/store/store.hpp"
#include "results/store/study_queries.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
// Throws StoreError with where it stands.
std::uint64_t seed_from(const std::string& text, const std::string& where) {
  std::uint64_t seed{};
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, seed);
  if (error != std::errc{} || stopped != end) {
    throw StoreError{fmt::format("{}: the seed '{}' is not a whole number below 2^64", where,
                                 core::cut_to(text, 80))};
  }
  return seed;
}

SessionRow session_from(Statement& row, const std::string& file) {
  SessionRow session;
  session.id = row.integer(0);
  session.participant_id = row.text(1);
  session.participant_index = row.small_integer(2);
  session.order_index = row.small_integer(3);
  session.mode = mode_from(row.text(4));
  session.seed = seed_from(row.text(5), fmt::format("{}: session {}", file, session.id));
  session.planned_order = row.text(6);
  session.language = row.text(7);
  session.resumes = row.flag(8) ? std::optional{row.integer(8)} : std::nullopt;
  session.rate_hz = row.real(9);
  session.rig_text = row.text(10);
  session.device = row.text(11);
  session.scheduler = row.text(12);
  session.doctor = row.text(13);
  session.program_version = row.text(14);
  session.git_hash = row.text(15);
  session.compiler = row.text(16);
  session.started_utc = row.text(17);
  if (const auto group = row.optional_text(18)) {
    session.group = group_from(*group, row.text(19));
  }
  session.planned_session = row.optional_text(20);
  session.protocol_text = row.optional_text(21);
  return session;
}
}  // namespace

std::string Store::session_columns() {
  return fmt::format(
      "session_id, participant_id, participant_index, order_index, mode, seed, planned_order, "
      "language, resumes, rate_hz, rig_text, device, scheduler, doctor, program_version, git_hash, "
      "compiler, started_utc, {}, {}",
      has_columns_of_groups() ? "group_name, group_assignment" : "NULL, NULL",
      has_columns_of_planned_sessions() ? "planned_session, protocol_text" : "NULL, NULL");
}

std::vector<SessionRow> Store::sessions() {
  std::vector<SessionRow> sessions;
  Statement row{database_, fmt::format("SELECT {} FROM session JOIN participant "
                                       "USING (participant_id) ORDER BY session_id",
                                       session_columns())};
  while (row.step()) {
    sessions.push_back(session_from(row, database_.file()));
  }
  return sessions;
}

std::set<std::int64_t> Store::session_ids() {
  std::set<std::int64_t> ids;
  Statement row{database_, "SELECT session_id FROM session"};
  while (row.step()) {
    ids.insert(row.integer(0));
  }
  return ids;
}

SessionRow Store::session_of(std::int64_t session_id) {
  Statement row{database_, fmt::format("SELECT {} FROM session JOIN participant "
                                       "USING (participant_id) WHERE session_id = ?",
                                       session_columns())};
  row.bind(session_id);
  if (!row.step()) {
    throw StoreError{fmt::format("{}: has no session {}", database_.file(), session_id)};
  }
  return session_from(row, database_.file());
}

namespace {
std::string journalled_answers_sql(const char* condition) {
  return fmt::format(
      "SELECT trial_id, session_id, number, attempt, block, task, is_practice, "
      "repetition, status, duration_s, response, is_correct, response_time_s, "
      "time_from_first_contact_s, confidence, is_catch, presented = 'real' "
      "FROM trial JOIN response USING (trial_id) JOIN session USING (session_id) "
      // by the plus not found by the index of superseding responses, which has those of everybody
      "WHERE status = 'answered' AND +supersedes IS NULL {} ORDER BY trial_id",
      condition);
}
}  // namespace

std::vector<JournalledAnswer> Store::answers_for_journal() {
  Statement row{database_, journalled_answers_sql("")};
  return journalled_answers(row);
}

std::vector<JournalledAnswer> Store::answers_as_given(const std::string& participant_id) {
  Statement row{database_, journalled_answers_sql("AND participant_id = ?")};
  row.bind(participant_id);
  return journalled_answers(row);
}

std::vector<JournalledAnswer> Store::journalled_answers(Statement& row) {
  std::vector<JournalledAnswer> answers;
  while (row.step()) {
    JournalledAnswer answer;
    answer.trial = {
        row.integer(1), row.small_integer(2), row.small_integer(3), row.text(4),
        row.text(5),    row.flag(6),          row.small_integer(7), trial_status_from(row.text(8)),
        row.real(9),    row.flag(15),         row.flag(16)};
    answer.response = {row.text(10), row.optional_flag(11), row.real(12), row.optional_real(13),
                       row.optional_int(14)};
    answer.alternatives = alternatives_of(row.integer(0));
    answers.push_back(std::move(answer));
  }
  return answers;
}

std::vector<AlternativeRow> Store::alternatives_of(std::int64_t trial_id) {
  return alternatives_where("WHERE trial_id = ?", trial_id)[trial_id];
}

AlternativesOfTrials Store::alternatives() {
  return alternatives_where("", {});
}

AlternativesOfTrials Store::alternatives_where(const char* condition,
                                               std::optional<std::int64_t> trial_id) {
  Statement row{database_, fmt::format("SELECT trial_id, position, label, stimulus, is_comparison "
                                       "FROM alternative {} ORDER BY trial_id, position",
                                       condition)};
  Statement value{
      database_,
      fmt::format("SELECT trial_id, position, axis, value FROM axis_value {}", condition)};
  if (trial_id) {
    row.bind(*trial_id);
    value.bind(*trial_id);
  }
  AlternativesOfTrials alternatives;
  while (row.step()) {
    alternatives[row.integer(0)].push_back(
        {row.small_integer(1), row.text(2), row.text(3), {}, row.flag(4)});
  }
  while (value.step()) {
    std::vector<AlternativeRow>& of_trial = alternatives[value.integer(0)];
    const auto position = static_cast<std::size_t>(value.integer(1));
    if (position >= of_trial.size()) {
      throw StoreError{fmt::format("{}: trial {} has no alternative {}, but a value of it",
                                   database_.file(), value.integer(0), position)};
    }
    of_trial[position].axis_values[value.text(2)] = value.real(3);
  }
  return alternatives;
}

std::optional<SessionRow> Store::latest_session(const std::string& participant_id,
                                                bool has_trials) {
  Statement row{database_,
                fmt::format("SELECT {} FROM session JOIN participant USING (participant_id) "
                            "WHERE participant_id = ?{} ORDER BY session_id DESC LIMIT 1",
                            session_columns(),
                            has_trials ? " AND session_id IN (SELECT session_id FROM trial)" : "")};
  row.bind(participant_id);
  return row.step() ? std::optional{session_from(row, database_.file())} : std::nullopt;
}

std::vector<std::string> Store::participant_ids() {
  Statement row{database_, "SELECT participant_id FROM participant"};
  std::vector<std::string> ids;
  while (row.step()) {
    ids.push_back(row.text(0));
  }
  return ids;
}

std::optional<std::int64_t> Store::session_of_trial(const std::string& participant_id, int number) {
  Statement row{database_,
                "SELECT session_id FROM trial JOIN session USING (session_id) "
                "WHERE participant_id = ? AND number = ? ORDER BY trial_id DESC LIMIT 1"};
  row.bind(participant_id).bind(number);
  return row.step() ? std::optional{row.integer(0)} : std::nullopt;
}

std::vector<int> Store::answered_trials(const std::string& participant_id) {
  Statement row{database_,
                "SELECT number FROM trial JOIN session USING (session_id) "
                "WHERE participant_id = ? AND status = 'answered' ORDER BY number"};
  row.bind(participant_id);
  std::vector<int> numbers;
  while (row.step()) {
    numbers.push_back(row.small_integer(0));
  }
  return numbers;
}

std::map<int, int> Store::presentations(const std::string& participant_id) {
  Statement row{database_,
                "SELECT number, max(attempts) FROM ("
                "  SELECT number, max(attempt) AS attempts FROM trial "
                "    JOIN session USING (session_id) WHERE participant_id = ?1 GROUP BY number "
                "  UNION ALL SELECT number, count(*) FROM session_event "
                "    JOIN session USING (session_id) "
                "    WHERE participant_id = ?1 AND state = 'exploring' GROUP BY number) "
                "GROUP BY number"};
  row.bind(participant_id);
  std::map<int, int> attempts;
  while (row.step()) {
    attempts.emplace(row.small_integer(0), row.small_integer(1));
  }
  return attempts;
}

std::vector<UnansweredTrial> Store::unanswered_trials(const std::string& participant_id) {
  const std::vector<int> answered = answered_trials(participant_id);
  Statement row{
      database_,
      "SELECT number, block, max(status = 'skipped') FROM trial "
      "JOIN session USING (session_id) WHERE participant_id = ? "
      "AND status IN ('timed_out', 'skipped') GROUP BY number, block ORDER BY max(trial_id)"};
  row.bind(participant_id);
  std::vector<UnansweredTrial> trials;
  while (row.step()) {
    const int number = row.small_integer(0);
    if (!std::ranges::binary_search(answered, number)) {
      trials.push_back({number, row.text(1), row.flag(2)});
    }
  }
  return trials;
}

std::vector<SurfaceRow> Store::surfaces() {
  Statement row{database_, "SELECT file, sha256, size, zstd FROM surface ORDER BY file"};
  std::vector<SurfaceRow> surfaces;
  while (row.step()) {
    const auto bytes = decompressed(row.bytes(3), static_cast<std::size_t>(row.integer(2)),
                                    fmt::format("{}: surface '{}'", database_.file(), row.text(0)));
    std::string text(bytes.size(), '\0');
    std::ranges::transform(bytes, text.begin(),
                           [](std::byte byte) { return std::to_integer<char>(byte); });
    surfaces.push_back({row.text(0), row.text(1), std::move(text)});
  }
  return surfaces;
}

std::vector<std::int64_t> Store::trials() {
  Statement row{database_, "SELECT trial_id FROM trial ORDER BY trial_id"};
  std::vector<std::int64_t> ids;
  while (row.step()) {
    ids.push_back(row.integer(0));
  }
  return ids;
}

std::vector<core::TraceSample> Store::trace(std::int64_t trial_id) {
  Statement row{database_,
                "SELECT codec, ticks, bytes FROM trace_chunk WHERE trial_id = ? "
                "ORDER BY first_tick"};
  row.bind(trial_id);
  std::vector<core::TraceSample> samples;
  while (row.step()) {
    const auto chunk =
        decoded_chunk(row, 0, fmt::format("{}: trace of trial {}", database_.file(), trial_id));
    samples.insert(samples.end(), chunk.begin(), chunk.end());
  }
  return samples;
}

bool Store::has_actuators() {
  return has_tables_of_actuators() && Statement{database_, "SELECT 1 FROM actuator"}.step();
}

std::optional<Store::StoredActuator> Store::actuator(std::int64_t trial_id) {
  if (!has_tables_of_actuators()) {
    return std::nullopt;
  }
  Statement row{database_,
                "SELECT rate_hz, delay_s, full_scale_n, last_n, mean_square_n2, ticks_lost, "
                "dropped_periods FROM actuator WHERE trial_id = ?"};
  row.bind(trial_id);
  if (!row.step()) {
    return std::nullopt;
  }
  StoredActuator stored{{row.real(0), row.real(1), row.real(2), row.real(3), row.real(4),
                         row.integer(5), row.integer(6)},
                        {}};
  Statement chunk{database_,
                  "SELECT codec, periods, samples, bytes FROM actuator_chunk WHERE trial_id = ? "
                  "ORDER BY first_period"};
  chunk.bind(trial_id);
  while (chunk.step()) {
    const std::string what = fmt::format("{}: actuator of trial {}", database_.file(), trial_id);
    check_codec(chunk.text(0), actuator_codec, what);
    ActuatorTrace read = decode_actuator(chunk.bytes(3), static_cast<std::size_t>(chunk.integer(1)),
                                         static_cast<std::size_t>(chunk.integer(2)), what);
    std::ranges::move(read.periods, std::back_inserter(stored.trace.periods));
    std::ranges::move(read.samples, std::back_inserter(stored.trace.samples));
  }
  return stored;
}

// These functions make sure that a trial is stored: on the disk, in the file of the study's name,
// whatever became of that file meanwhile.
namespace fs = std::filesystem;

void Store::suspend_sync() {
  confirms_ = false;
  database_.run("PRAGMA synchronous = OFF");
  journal_->set_flush(Journal::Flush::when_asked);
}

void Store::resume_sync() {
  commit_batch();
  confirms_ = true;
  database_.run("PRAGMA synchronous = FULL");
  static_cast<void>(database_.checkpoint());
  check_has_not_moved();
  journal_->set_flush(Journal::Flush::each_time);
  journal_->flush();
}

// The log of the deleted file must not be taken for the new one's.
void Store::rewrite_database() {
  const std::string file = fs::absolute(database_.file()).string();
  const std::string unfinished = file + ".unfinished";
  std::error_code error;
  fs::remove(unfinished, error);  // of an earlier try, on a full disk
  Statement{database_, "VACUUM INTO ?"}.bind(unfinished).finish();
  for (const char* const beside : {"-wal", "-shm"}) {
    fs::remove(file + beside, error);
  }
  fs::rename(unfinished, file, error);
  if (error) {
    throw StoreError{fmt::format("{}: cannot be written: {}", file, error.message())};
  }
  core::flush_directory(fs::path{file}.parent_path().string());
}

void Store::check_has_not_moved() {
  const fs::path file{database_.file()};
  std::error_code error;
  if (database_.has_moved()) {
    if (!fs::exists(file, error) && fs::is_directory(fs::absolute(file).parent_path(), error)) {
      rewrite_database();
      throw StoreRewritten{
          fmt::format("{}: was deleted during the session; its contents are in a new file of that "
                      "name (go on with "
                      "--resume)",
                      database_.file())};
    }
    throw StoreError{fmt::format(
        "{}: was moved or replaced (put it back: all answers are in the file that was moved)",
        database_.file())};
  }
}

// Read back by whoever opens the file of that name.
void Store::check_is_in_place(const TrialRow& trial) {
  check_has_not_moved();
  Database by_name{database_.file(), Database::Access::read};
  Statement row{by_name, "SELECT 1 FROM trial WHERE session_id = ? AND number = ? AND attempt = ?"};
  row.bind(trial.session_id).bind(trial.number).bind(trial.attempt);
  if (!row.step()) {
    throw StoreError{database_.file() + ": what was stored cannot be read back"};
  }
}
}  // namespace tapstudy::results
