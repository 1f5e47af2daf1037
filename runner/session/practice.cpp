#include "runner/session/practice.hpp"

#include <fmt/format.h>

#include "runner/terminal/exit_code.hpp"
namespace tapstudy::runner {
void Practice::add(const protocols::PlannedTrial& trial, const std::string& response) {
  const protocols::Block& block = protocol_.block(trial.block);
  if (block.criterion) {
    record_.add(block.name, trial.task->is_correct(trial, block, response).value_or(false));
  }
}

bool Practice::is_needed(const protocols::PlannedTrial& next, const protocols::Schedule& schedule) {
  for (const protocols::PlannedTrial& trial : schedule) {
    if (trial.block == next.block) {
      break;
    }
    note(protocol_.block(trial.block));
  }
  const protocols::Block& own = protocol_.block(next.block);
  const bool is_met = record_.is_met(own);
  if (is_met) {
    note(own);
  }
  return !is_met;
}

void Practice::note(const protocols::Block& block) {
  if (!block.criterion || !noted_.insert(block.name).second) {
    return;
  }
  const bool is_met = record_.is_met(block);
  const std::string what =
      fmt::format("{}: {}, {}", block.name, is_met ? "met" : "not met", record_.latest(block));
  states_.enter(SessionState::practised, {}, what);
  if (!is_met && block.criterion->must_be_met) {
    throw PracticeMissed{
        fmt::format("the practice criterion of block {}; every answer is kept", what)};
  }
}
}  // namespace tapstudy::runner
