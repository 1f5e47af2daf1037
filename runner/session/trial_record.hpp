#pragma once
#include <optional>

#include "protocols/schedule.hpp"
#include "results/rows.hpp"
#include "runner/trial_loop/trial_loop.hpp"
namespace tapstudy::runner {
struct Answer {
  std::string response;  // as the task stores it
  double response_time_s{};
  std::optional<int> confidence{};
};
// A trial as the store takes it.
results::TrialRecord trial_record(std::int64_t session_id, const protocols::PlannedTrial& trial,
                                  const protocols::Block& block, int attempt,
                                  results::TrialStatus status, const std::optional<Answer>& answer,
                                  TrialResult result);
}  // namespace tapstudy::runner
