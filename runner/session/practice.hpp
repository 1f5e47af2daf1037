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
  // Whether the trial is not needed: its block's criterion is met.
  bool is_over(const protocols::PlannedTrial& trial) const;
  // Throws PracticeMissed where an earlier block's criterion had to be met.
  void check(const protocols::PlannedTrial& next);

 private:
  const protocols::Protocol& protocol_;
  SessionStates& states_;
  PracticeRecord record_;
  std::set<std::string> missed_;  // blocks
};
}  // namespace tapstudy::runner
