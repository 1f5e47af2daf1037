#include "runner/session/practice_record.hpp"

#include <fmt/format.h>

#include <algorithm>
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
}  // namespace tapstudy::runner
