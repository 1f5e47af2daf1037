// What reads a study's rows back.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "results/compression.hpp"
#include "results/store.hpp"
#include "results/trace_codec.hpp"
namespace tapstudy::results {
namespace {
std::uint64_t seed_from(const std::string& text) {
  std::uint64_t seed{};
  std::from_chars(text.data(), text.data() + text.size(), seed);
  return seed;
}

constexpr const char* session_columns =
    "session_id, participant_id, participant_index, mode, seed, planned_order, resumes, rate_hz, "
    "rig_text, device, scheduler, doctor, program_version, git_hash, compiler, started_utc";

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
  session.doctor = row.text(11);
  session.program_version = row.text(12);
  session.git_hash = row.text(13);
  session.compiler = row.text(14);
  session.started_utc = row.text(15);
  return session;
}
}  // namespace

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
  Statement row{database_,
                "SELECT participant_id, mode, block, task, is_practice, number, "
                "  CASE WHEN EXISTS (SELECT 1 FROM alternative AS second "
                "    WHERE second.trial_id = trial.trial_id AND second.position = 1) THEN '' "
                "  ELSE (SELECT stimulus FROM alternative "
                "    WHERE alternative.trial_id = trial.trial_id AND position = 0) END, "
                "  response, is_correct, response_time_s, ticks, late, skipped, dropped_samples "
                "FROM trial JOIN session USING (session_id) JOIN response USING (trial_id) "
                "JOIN tick_statistics USING (trial_id) JOIN participant USING (participant_id) "
                "ORDER BY participant_index, number"};
  std::vector<AnswerRow> answers;
  while (row.step()) {
    answers.push_back(
        {row.text(0), mode_from(row.text(1)), row.text(2), row.text(3), row.integer(4) != 0,
         static_cast<int>(row.integer(5)), row.text(6), row.text(7),
         row.is_null(8) ? std::nullopt : std::optional{row.integer(8) != 0}, row.real(9),
         row.integer(10), row.integer(11), row.integer(12), row.integer(13)});
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
      "WHERE status = 'answered' AND EXISTS (SELECT 1 FROM alternative AS second "
      "  WHERE second.trial_id = visit.trial_id AND second.position = 1) "
      "GROUP BY participant_index, block, stimulus ORDER BY participant_index, block, stimulus"};
  std::vector<VisitRow> visits;
  while (row.step()) {
    visits.push_back(
        {row.text(0), row.text(1), row.text(2), static_cast<int>(row.integer(3)), row.real(4)});
  }
  return visits;
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

std::vector<core::TraceSample> Store::trace(std::int64_t trial_id) {
  Statement row{database_,
                "SELECT ticks, bytes FROM trace_chunk WHERE trial_id = ? ORDER BY first_tick"};
  row.bind(trial_id);
  std::vector<core::TraceSample> samples;
  while (row.step()) {
    const auto chunk =
        decode_trace(row.bytes(1), static_cast<std::size_t>(row.integer(0)),
                     fmt::format("{}: trace of trial {}", database_.file(), trial_id));
    samples.insert(samples.end(), chunk.begin(), chunk.end());
  }
  return samples;
}
}  // namespace tapstudy::results
