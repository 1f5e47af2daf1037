#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
namespace tapstudy::protocols {
// The order in which one participant does the protocol's blocks: their places in its list. Seed and
// index as for make_schedule.
std::vector<std::size_t> block_sequence(const Protocol& protocol, std::uint64_t participant_seed,
                                        int order_index);

// The number of each block's first trial, by the block's name.
std::map<std::string, int> first_trials(const Protocol& protocol, std::uint64_t participant_seed,
                                        int order_index);

// How many participants it takes to balance the order of the blocks; 1 where it is not balanced.
int balanced_block_orders(const Protocol& protocol);
}  // namespace tapstudy::protocols
