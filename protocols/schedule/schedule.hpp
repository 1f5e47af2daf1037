#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
namespace tapstudy::protocols {
using Schedule = std::vector<PlannedTrial>;

// The complete trial order of one participant. The seed is the participant's own; counterbalancing
// uses the order index, from 0, within the participant's group where the protocol has groups: of
// its blocks there are no others. The result does not depend on the compiler.
Schedule make_schedule(const Protocol& protocol, std::uint64_t participant_seed, int order_index);

// The same where the order of the blocks is stored already, as described(): other versions may have
// drawn another one.
Schedule make_schedule(const Protocol& protocol, std::uint64_t participant_seed, int order_index,
                       const std::string& planned_order);

// The trials of one of the protocol's sessions. Their numbers are those of the participant's whole
// order.
Schedule trials_of_session(const Schedule& schedule, const Protocol& protocol,
                           const std::string& session);

// How many trials a participant has of it.
int planned_trials(const Block& block);

// The draw of a block's order, by index_in_group. Catch trials lie where the study's own seed puts
// them.
Draw draw_of(std::uint64_t counterbalancing_seed, std::size_t block_index,
             std::uint64_t participant_seed, int index);

// One line a trial, for the store and for people.
std::string described(const Schedule& schedule);

// The order in which one participant does the blocks of the protocol, or of the group, session by
// session: their places in the protocol's list. Seed and index as for make_schedule.
std::vector<std::size_t> block_sequence(const Protocol& protocol, std::uint64_t participant_seed,
                                        int order_index);

// The number of each block's first trial, by the block's name, in an order as described().
std::map<std::string, int> first_trials(const std::string& planned_order);

// How many participants of the group (nullptr: of a protocol without groups) it takes to balance
// the order of its blocks; 1 where it is not balanced.
int balanced_block_orders(const Protocol& protocol, const Group* group);
}  // namespace tapstudy::protocols
