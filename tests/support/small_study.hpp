#pragma once
#include <string>
#include <vector>

#include "core/sha256.hpp"
#include "results/store.hpp"
#include "results/trace_codec.hpp"
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

inline results::TrialRecord trial(std::int64_t session_id, int number,
                                  const std::string& response) {
  results::TrialRecord record;
  record.trial = {session_id, number, 1, "main", "identification", false, 1, "answered", 2.0};
  record.alternatives = {{0, "", "a"}};
  record.response = results::ResponseRow{response, response == "a", 1.5, 1.25};
  record.events = {{0.1, "contact", 0.0}};
  record.trace = {{0, 3, results::encode_trace(std::vector<core::TraceSample>(3))}};
  record.statistics.ticks = 3;
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
