#pragma once
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "results/journal.hpp"
#include "runner/session/practice_record.hpp"
namespace tapstudy::runner {
using FilledForms = std::set<std::pair<std::string, std::string>>;  // form, where it was asked

// What a participant has answered in earlier sessions that a new one depends on.
struct EarlierAnswers {
  FilledForms filled_forms{};
  PracticeRecord practice{};
  std::vector<results::JournalledAnswer> as_given{};  // in that order
  std::map<int, int> attempts{};                      // of each trial, by its number
  std::vector<int> requeued{};                        // trials to come again, the last one last
};
}  // namespace tapstudy::runner
