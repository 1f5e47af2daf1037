#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
namespace tapstudy::protocols {
// Permuted blocks (Schulz & Grimes 2002): of each run of as many order indices as there are groups,
// from 0 on, every group has one, in an order that the study's counterbalancing seed draws for the
// run. The group of an index therefore depends on nothing that happens during the study.

// Of so many groups, the place of the one that this order index is of.
std::size_t place_of_group(std::uint64_t counterbalancing_seed, std::size_t groups,
                           int order_index);
// nullptr: the protocol has no groups.
const Group* group_of(const Protocol& protocol, int order_index);

// Which of its group's participants the one with this order index is, from 0: the index that
// counterbalances orders. Without groups the order index itself.
int index_in_group(const Protocol& protocol, int order_index);
int index_in_group(std::size_t groups, int order_index);

// Whether the group does the block; nullptr does all.
bool does(const Group* group, const Block& block);

// The block as it is presented to the group: with the group's stimuli. Answers, and which of them
// are right, are those of the whole block.
Block block_of(const Group* group, const Block& block);

// How often each answer is right, of its stimuli presented once.
std::map<std::string, int> right_answers(const Block& block);

// How many of the first so many participants are in the group (nullptr: all), or do the block.
int members(const Protocol& protocol, const Group* group, int participants);
int participants_of(const Protocol& protocol, const Block& block, int participants);

// Each group, or nullptr alone where the protocol has none.
std::vector<const Group*> groups_of(const Protocol& protocol);
}  // namespace tapstudy::protocols
