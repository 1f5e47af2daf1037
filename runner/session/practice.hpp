#pragma once
#include <set>
#include <string>

#include "protocols/protocol.hpp"
#include "protocols/schedule.hpp"
#include "runner/session/practice_record.hpp"
#include "runner/session/session_states.hpp"
namespace tapstudy::runner {
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
