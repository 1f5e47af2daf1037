#pragma once
#include <set>

#include "protocols/protocol.hpp"
#include "protocols/schedule.hpp"
#include "runner/participants/participant.hpp"
namespace tapstudy::runner {
// Before this trial: counted among the practice, or among the trials that count, that it is one of.
// `done` are the numbers of those that need not come again.
TrialProgress progress_at(const protocols::PlannedTrial& trial, const protocols::Schedule& schedule,
                          const std::set<int>& done, const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
