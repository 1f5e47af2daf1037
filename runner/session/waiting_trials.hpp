#pragma once
#include <deque>
#include <set>
#include <vector>

#include "protocols/schedule.hpp"
namespace tapstudy::runner {
// After the last waiting trial of its block.
void put_at_end_of_block(const protocols::PlannedTrial& trial,
                         std::deque<protocols::PlannedTrial>& waiting);

// Of the schedule those that are not done, in its order, but for those that were requeued: these
// come at the end of their blocks in the order of their numbers here, as they would have had the
// session gone on.
std::deque<protocols::PlannedTrial> waiting_trials(const protocols::Schedule& schedule,
                                                   const std::set<int>& done,
                                                   const std::vector<int>& requeued);
}  // namespace tapstudy::runner
