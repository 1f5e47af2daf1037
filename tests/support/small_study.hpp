#pragma once
#include <string>
#include <vector>

#include "core/sha256.hpp"
#include "results/store.hpp"
#include "results/trace_codec.hpp"
#include "results/trace_events.hpp"
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
