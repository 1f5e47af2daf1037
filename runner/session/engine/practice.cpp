#include "runner/session/engine/practice.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runner/terminal/process_exit.hpp"
namespace tapstudy::runner {
PracticeRecord::PracticeRecord(const std::vector<results::JournalledAnswer>& answers) {
  for (const results::JournalledAnswer& answer : answers) {
    if (answer.trial.is_practice) {
      add(answer.trial.block, answer.response.is_correct.value_or(false));
    }
  }
}

bool PracticeRecord::is_met(const protocols::Block& block) const {
  const auto answers = answers_.find(block.name);
  if (!block.criterion || answers == answers_.end()) {
    return false;
  }
  const std::vector<bool>& all = answers->second;
  const auto window = static_cast<std::ptrdiff_t>(block.criterion->of_last);
  for (auto end = window; end <= std::ssize(all); ++end) {
    if (std::count(all.begin() + end - window, all.begin() + end, true) >=
        block.criterion->correct) {
      return true;
    }
  }
  return false;
}

std::string PracticeRecord::latest(const protocols::Block& block) const {
  const auto answers = answers_.find(block.name);
  const std::vector<bool> all = answers == answers_.end() ? std::vector<bool>{} : answers->second;
  const auto window = std::min<std::ptrdiff_t>(block.criterion->of_last, std::ssize(all));
  return fmt::format("{} of the last {} right", std::count(all.end() - window, all.end(), true),
                     window);
}

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
