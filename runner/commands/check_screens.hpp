#pragma once
#include <map>
#include <string>

#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// How many trials a participant has of a block.
struct BlockLength {
  int usual{};
  int most{};  // 19 of 20 people need no more
  int limit{};
};
using BlockLengths = std::map<std::string, BlockLength>;  // by the block's name

// Blocks whose procedures may end early are as long as for simulated people, all others as planned.
BlockLengths lengths_of(const protocols::Protocol& protocol);
// Those of one of the group's, who is presented the group's stimuli.
BlockLengths lengths_for(const protocols::Group* group, const protocols::Protocol& protocol,
                         BlockLengths lengths);
// "8 trials", "at most 20 trials", "about 38 trials (simulated; up to 52 for 19 of 20 people, at
// most 1000)"
std::string describe_length(const protocols::Block& block, const BlockLength& length);

// Seconds that one participant of the group (nullptr: anybody) spends on the screens, roughly;
// without the tapping.
double seconds_of_screens(const protocols::Protocol& protocol, const protocols::Group* group,
                          const BlockLengths& lengths);
// Prints the screens that one participant of each group sees, in their order, if no trial is
// repeated.
void print_screens(const protocols::Protocol& protocol, const BlockLengths& lengths);
}  // namespace tapstudy::runner
