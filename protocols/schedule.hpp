#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
namespace tapstudy::protocols {
struct PlannedTrial {
  int number{};  // from 1, in the order presented
  std::string block;
  Task task{};
  bool is_practice{false};
  int repetition{};  // from 1
  // identification: the one stimulus; choice: the alternatives in the order of their blind labels
  // A, B, C …, an order drawn once per participant.
  std::vector<std::string> stimuli;
};
using Schedule = std::vector<PlannedTrial>;

// The whole order of one participant. The seed is the participant's own; counterbalancing counts
// participants from 0. The same arguments give the same order on every compiler.
Schedule make_schedule(const Protocol& protocol, std::uint64_t participant_seed,
                       int participant_index);

// One line a trial, for the store and for people.
std::string described(const Schedule& schedule);

// Row `row` of a balanced Latin square of n conditions (Williams 1949, by the construction of
// Bradley 1958): every condition follows every other equally often. n rows if n is even, else 2 n.
std::vector<int> williams_row(int n, int row);
int williams_rows(int n);

// "A", "B", … for the alternatives of a choice.
std::string blind_label(std::size_t position);
}  // namespace tapstudy::protocols
