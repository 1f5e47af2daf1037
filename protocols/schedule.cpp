#include "protocols/schedule.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocols/block_order.hpp"
namespace tapstudy::protocols {
int planned_trials(const Block& block) {
  return block.repetitions * static_cast<int>(block.task->trials_per_repetition(block)) +
         (block.catch_trials ? block.catch_trials->count : 0);
}

Draw draw_of(std::uint64_t counterbalancing_seed, std::size_t block_index,
             std::uint64_t participant_seed, int order_index) {
  return {participant_seed, order_index, block_index, counterbalancing_seed,
          core::derived_seed(counterbalancing_seed, core::Purpose::catch_trials,
                             static_cast<std::uint64_t>(order_index))};
}

Schedule make_schedule(const Protocol& protocol, std::uint64_t participant_seed, int order_index) {
  Schedule schedule;
  for (const std::size_t i : block_sequence(protocol, participant_seed, order_index)) {
    const Block& block = protocol.blocks[i];
    const Draw draw = draw_of(protocol.counterbalancing_seed, i, participant_seed, order_index);
    for (PlannedTrial& trial : block.task->trials(block, draw)) {
      trial.number = static_cast<int>(schedule.size()) + 1;
      schedule.push_back(std::move(trial));
    }
  }
  return schedule;
}

namespace {
// "family at E = 2, family *": what a procedure will choose has a star.
std::vector<std::string> described(const std::vector<Alternative>& alternatives) {
  std::vector<std::string> words;
  for (const Alternative& alternative : alternatives) {
    words.push_back(alternative.stimulus);
    if (!alternative.values.empty()) {
      words.back() += " at " + protocols::described(alternative.values);
    } else if (alternative.is_comparison) {
      words.back() += " *";
    }
  }
  return words;
}
}  // namespace

std::string described(const Schedule& schedule) {
  std::string lines;
  for (const PlannedTrial& trial : schedule) {
    lines += fmt::format("{} {} {} {}{}{}\n", trial.number, trial.block, trial.repetition,
                         fmt::join(described(trial.alternatives), ","),
                         trial.is_practice ? " practice" : "", trial.is_catch ? " catch" : "");
  }
  return lines;
}
}  // namespace tapstudy::protocols
