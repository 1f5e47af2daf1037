#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
namespace tapstudy::protocols {
using Schedule = std::vector<PlannedTrial>;

// The complete trial order of one participant. The seed is the participant's own; counterbalancing
// uses the participant index, from 0. The result does not depend on the compiler.
Schedule make_schedule(const Protocol& protocol, std::uint64_t participant_seed, int order_index);

// How many trials a participant has of it.
int planned_trials(const Block& block);

// The draw of a block's order. Catch trials lie where the study's own seed puts them.
Draw draw_of(std::uint64_t counterbalancing_seed, std::size_t block_index,
             std::uint64_t participant_seed, int order_index);

// One line a trial, for the store and for people.
std::string described(const Schedule& schedule);
}  // namespace tapstudy::protocols
