#pragma once
#include <vector>

#include "protocols/protocol.hpp"
#include "protocols/schedule.hpp"
#include "results/rows.hpp"
namespace tapstudy::runner {
// A trial as it was presented, as its task sees it.
protocols::PlannedTrial stored_trial(const results::TrialRow& row,
                                     const std::vector<results::AlternativeRow>& alternatives,
                                     const protocols::Block& block);
}  // namespace tapstudy::runner
