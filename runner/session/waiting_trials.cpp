#include "runner/session/waiting_trials.hpp"

#include <algorithm>
#include <iterator>
namespace tapstudy::runner {
using protocols::PlannedTrial;

void put_at_end_of_block(const PlannedTrial& trial, std::deque<PlannedTrial>& waiting) {
  const auto last = std::find_if(waiting.rbegin(), waiting.rend(), [&](const PlannedTrial& other) {
    return other.block == trial.block;
  });
  waiting.insert(last == waiting.rend() ? waiting.begin() : last.base(), trial);
}

std::deque<PlannedTrial> waiting_trials(const protocols::Schedule& schedule,
                                        const std::set<int>& done,
                                        const std::vector<int>& requeued) {
  std::deque<PlannedTrial> waiting;
  std::ranges::copy_if(schedule, std::back_inserter(waiting),
                       [&](const PlannedTrial& trial) { return !done.contains(trial.number); });
  for (const int number : requeued) {
    const auto found = std::ranges::find(waiting, number, &PlannedTrial::number);
    if (found == waiting.end()) {
      continue;
    }
    const std::string block = found->block;
    const auto end = std::find_if(found, waiting.end(),
                                  [&](const PlannedTrial& other) { return other.block != block; });
    std::rotate(found, std::next(found), end);
  }
  return waiting;
}
}  // namespace tapstudy::runner
