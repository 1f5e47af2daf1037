#pragma once
#include <string>
#include <vector>

#include "core/rng.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::protocols {
struct OrderedStimulus {
  std::string stimulus;
  int repetition{};  // counts the presentations of this stimulus, from 1
};
// A block's stimuli in the specified order, each presented `repetitions` times.
std::vector<OrderedStimulus> ordered_stimuli(const Block& block, core::Rng& rng,
                                             int participant_index);

// Row `row` of a balanced Latin square of n conditions (Williams 1949, by the construction of
// Bradley 1958): every condition follows every other equally often. n rows if n is even, otherwise
// 2 n.
std::vector<int> williams_row(int n, int row);
int williams_rows(int n);
}  // namespace tapstudy::protocols
