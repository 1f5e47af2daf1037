#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/journal/journal.hpp"
#include "runner/session/engine/session_states.hpp"
namespace tapstudy::runner {
// How well a participant has answered the practice blocks that have a criterion.
class PracticeRecord {
 public:
  PracticeRecord() = default;
  // Of earlier sessions: the participant's answers to whatever blocks, as they were given: a
  // correction changes what is known, but not how well was practised.
  explicit PracticeRecord(const std::vector<results::JournalledAnswer>& answers);
  void add(const std::string& block, bool is_correct) { answers_[block].push_back(is_correct); }
  // Whether the block's criterion was met at any time; false if it has none.
  bool is_met(const protocols::Block& block) const;
  // "7 of the last 8 right".
  std::string latest(const protocols::Block& block) const;

 private:
  std::map<std::string, std::vector<bool>> answers_;  // in the order given
};

// Practice blocks with a criterion: when one is over, and whether the study may begin.
class Practice {
 public:
  Practice(const protocols::Protocol& protocol, SessionStates& states, PracticeRecord earlier)
      : protocol_{protocol}, states_{states}, record_{std::move(earlier)} {}
  void add(const protocols::PlannedTrial& trial, const std::string& response);
  // Between trials. False: its block's criterion is met. What became of that criterion and of
  // those of blocks that came before, in this schedule, is noted, once. Throws PracticeMissed where
  // an earlier one had to be met.
  bool is_needed(const protocols::PlannedTrial& next, const protocols::Schedule& schedule);

 private:
  void note(const protocols::Block& block);
  const protocols::Protocol& protocol_;
  SessionStates& states_;
  PracticeRecord record_;
  std::set<std::string> noted_;  // blocks
};
}  // namespace tapstudy::runner
