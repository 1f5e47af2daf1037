#pragma once
#include <array>
#include <string>
#include <vector>

#include "core/files/sha256.hpp"
#include "results/store/store.hpp"
#include "results/traces/trace_codec.hpp"
#include "results/traces/trace_collector.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
// The smallest study that a store takes, and its trials.
namespace tapstudy::testing::small_study {
inline const results::StudyRow study{
    "a study", "study.yaml", "format: tapstudy/1", core::sha256("format: tapstudy/1"), {}};

inline results::SessionRow session(const std::string& participant,
                                   results::Mode mode = results::Mode::real) {
  results::SessionRow row;
  row.participant_id = participant;
  row.mode = mode;
  row.seed = 0xfedcba9876543210ULL;  // does not fit a signed integer
  row.planned_order = "1 main 1 a\n";
  row.rate_hz = 1000.0;
  row.started_utc = "2026-01-01T00:00:00Z";
  return row;
}

inline core::TraceSample sample(std::int64_t t_ns, bool is_touching) {
  core::TraceSample tick{};
  tick.t_ns = t_ns;
  tick.touching = is_touching;
  return tick;
}

// Makes what is derived from a trace what it would have been in a session.
inline void set_trace(results::TrialRecord& record, const std::vector<core::TraceSample>& trace) {
  record.events.clear();
  results::TraceEvents events;
  for (const core::TraceSample& tick : trace) {
    events.add(tick, record.events);
  }
  const auto ticks = static_cast<std::int64_t>(trace.size());
  record.trace = {{0, ticks, results::encode_trace(trace)}};
  record.statistics.ticks = ticks;
  record.trial.duration_s = results::time_s(trace.back());
}

inline results::TrialRecord trial(std::int64_t session_id, int number,
                                  const std::string& response) {
  results::TrialRecord record;
  record.trial = {
      session_id, number, 1, "main", "identification", false, 1, results::TrialStatus::answered,
      2.0};
  record.alternatives = {{0, "", "a"}};
  record.response = results::ResponseRow{response, response == "a", 1.5, 1.25};
  set_trace(record, {sample(0, false), sample(250'000'000, true), sample(2'000'000'000, true)});
  return record;
}

struct BegunStudy {
  results::Store store;
  results::SessionRow row;
};
// With one participant, P01, and no trial.
inline BegunStudy begun_study(const std::string& directory) {
  BegunStudy begun{results::Store::open_or_create(directory, study), session("P01")};
  begun.store.add_session(begun.row);
  return begun;
}
}  // namespace tapstudy::testing::small_study

// A simulated study to which people are added who write what breaks careless formats.
namespace tapstudy::testing::messy_study {
inline const std::string text =
    "say \"hi\", then\nleave\r\n\ttab, \xE6\x97\xA5\xE6\x9C\xAC \xC3\xA4; 'x' \\n #1";
inline const std::string formula = "=cmd()|'/C calc'!A0";
inline const std::string participant = "Anna, \"the\" M\xC3\xBCller";

inline results::TrialRecord trial(std::int64_t session_id, int number,
                                  const std::string& response) {
  results::TrialRecord record = small_study::trial(session_id, number, response);
  std::vector<core::TraceSample> trace(6);
  trace[1] = small_study::sample(250'000'000, true);
  trace[1].impact = true;
  trace[1].velocity_m_s = {0.0, -0.3, 0.0};
  for (std::size_t i = 2; i < trace.size(); ++i) {
    trace[i].t_ns =
        std::array<std::int64_t, 4>{500'000'000, 900'000'000, 950'000'000, 2'000'000'000}[i - 2];
  }
  trace[2].alternative = 1;
  small_study::set_trace(record, trace);
  record.response->is_correct = response == "bare";
  record.alternatives = {{0, "A", "bare", {{"thickness_m", 0.1 + 0.2}}},
                         {1, formula, "ringing", {}, true}};
  return record;
}

inline void add_people(const std::string& directory) {
  const results::StudyRow study = results::Store::open_existing(directory).study();
  results::Store store = results::Store::open_or_create(directory, study);
  results::SessionRow first = small_study::session(participant);
  first.participant_index = 0;
  first.rig_text = "device: simulated_hand\n";
  store.add_session(first);
  store.add_trial(trial(first.id, 1, "bare"));
  results::TrialRecord skipped = trial(first.id, 2, "bare");
  skipped.response.reset();
  skipped.trial.status = results::TrialStatus::skipped;
  store.add_trial(skipped);
  store.add_trial(trial(first.id, 3, formula));
  store.add_correction({first.id, 3, "ringing", false}, {first.id, 9.5, "correct", 3, formula});
  store.add_operator_action({first.id, 10.0, "note", {}, text});
  store.add_form({{first.id, 11.0, "about", "session begin", "age", {}},
                  {first.id, 11.0, "about", "session begin", "hand", "left"},
                  {first.id, 12.0, "rating", "main", "remarks", text},
                  {first.id, 12.0, "rating", "main", "clear", formula}});
  results::SessionRow second = small_study::session("P02", results::Mode::pilot);
  second.participant_index = 0;
  store.add_session(second);
  store.add_trial(trial(second.id, 1, "ringing"));
  store.add_operator_action({second.id, 3.0, "exclude", {}, "left, \"early\""});
  results::SessionRow third = small_study::session("P03", results::Mode::pilot);
  third.participant_index = 1;
  store.add_session(third);
  store.add_operator_action({third.id, 1.0, "exclude", {}, "by mistake"});
  store.add_operator_action({third.id, 2.0, "include", {}, ""});
}

// DIR/study: of tests/data/every_screen.yaml.
inline std::string make(const TempDirectory& directory) {
  const std::string study = directory / "study";
  const auto run = tapstudy({"simulate", source("tests/data/every_screen.yaml"), "--participants",
                             "2", "--seed", "3", "--out", study});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  add_people(study);
  return study;
}
}  // namespace tapstudy::testing::messy_study
