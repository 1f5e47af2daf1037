#include "protocols/schedule.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
namespace tapstudy::protocols {
Schedule make_schedule(const Protocol& protocol, std::uint64_t participant_seed, int order_index) {
  Schedule schedule;
  for (std::size_t i = 0; i < protocol.blocks.size(); ++i) {
    const Block& block = protocol.blocks[i];
    for (PlannedTrial& trial : block.task->trials(
             block, {participant_seed, order_index, i, protocol.counterbalancing_seed})) {
      trial.number = static_cast<int>(schedule.size()) + 1;
      schedule.push_back(std::move(trial));
    }
  }
  return schedule;
}

std::string described(const Schedule& schedule) {
  std::string lines;
  for (const PlannedTrial& trial : schedule) {
    lines += fmt::format("{} {} {} {}{}\n", trial.number, trial.block, trial.repetition,
                         fmt::join(trial.stimuli, ","), trial.is_practice ? " practice" : "");
  }
  return lines;
}
}  // namespace tapstudy::protocols
