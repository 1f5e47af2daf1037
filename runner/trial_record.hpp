#pragma once
#include <optional>

#include "protocols/schedule.hpp"
#include "results/rows.hpp"
#include "runner/presenter.hpp"
namespace tapstudy::runner {
struct Answer {
  std::string stimulus;  // identification: the answered one; choice: the chosen one
  double response_time_s{};
};
// A trial as the store takes it. Without an answer it is one that was interrupted.
results::TrialRecord trial_record(std::int64_t session_id, const protocols::PlannedTrial& trial,
                                  int attempt, const std::optional<Answer>& answer,
                                  Presented presented);
std::string to_text(protocols::Task task);
}  // namespace tapstudy::runner
