#include "runner/session/practice.hpp"

#include <fmt/format.h>

#include "runner/terminal/exit_code.hpp"
namespace tapstudy::runner {
bool Practice::is_over(const protocols::PlannedTrial& trial) const {
  return record_.is_met(protocol_.block(trial.block));
}

void Practice::add(const protocols::PlannedTrial& trial, const std::string& response) {
  const protocols::Block& block = protocol_.block(trial.block);
  if (!block.criterion) {
    return;
  }
  record_.add(block.name, trial.task->is_correct(trial, block, response).value_or(false));
  if (record_.is_met(block)) {
    states_.enter(SessionState::practised, {},
                  fmt::format("{}: met, {}", block.name, record_.latest(block)));
  }
}

void Practice::check(const protocols::PlannedTrial& next) {
  for (const protocols::Block& block : protocol_.blocks) {
    if (block.name == next.block) {
      return;
    }
    if (!block.criterion || record_.is_met(block) || !missed_.insert(block.name).second) {
      continue;
    }
    const std::string missed = fmt::format("{}: not met, {}", block.name, record_.latest(block));
    states_.enter(SessionState::practised, {}, missed);
    if (block.criterion->must_be_met) {
      throw PracticeMissed{
          fmt::format("the practice criterion of block {}; every answer is kept", missed)};
    }
  }
}
}  // namespace tapstudy::runner
