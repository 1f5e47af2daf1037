#pragma once
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/store/store.hpp"
#include "runner/session/participants/participant.hpp"
namespace tapstudy::runner {
// The trials that ended without an answer and do not come again: skipped by the operator, but for
// those of procedures, or timed out (at_limit: give_up).
std::vector<int> given_up_trials(const protocols::Protocol& protocol,
                                 const std::string& participant_id, results::Store& store);
// Those that were never presented, because their block's criterion was met before, its procedures
// were finished, or it is not presented to who answered the forms so.
std::vector<int> unneeded_trials(const protocols::Protocol& protocol,
                                 const std::string& participant_id, results::Store& store);

// Of the trials planned for a participant's latest session, those that need not be presented any
// more: answered, given up or unneeded.
struct TrialsDone {
  std::ptrdiff_t done{};
  std::ptrdiff_t planned{};
  bool are_all() const { return done >= planned; }
};
TrialsDone trials_done(const protocols::Protocol& protocol, const std::string& participant_id,
                       results::Store& store);

// After the last waiting trial of its block.
void put_at_end_of_block(const protocols::PlannedTrial& trial,
                         std::deque<protocols::PlannedTrial>& waiting);

// Of the schedule those that are not done, in its order, but for those that were requeued: these
// come at the end of their blocks in the order of their numbers here, as they would have had the
// session gone on.
std::deque<protocols::PlannedTrial> waiting_trials(const protocols::Schedule& schedule,
                                                   const std::set<int>& done,
                                                   const std::vector<int>& requeued);

// How far a participant is, kept as trials are done: it takes as long with few trials as with many.
// done: the numbers of those that need not come again.
class SessionProgress {
 public:
  SessionProgress(const protocols::Schedule& schedule, const std::set<int>& done,
                  const protocols::Protocol& protocol);
  // One of the schedule's that was not done before.
  void note_done(const protocols::PlannedTrial& trial);
  // Before this trial: counted among the practice, or among the trials that count, that it is of.
  TrialProgress before(const protocols::PlannedTrial& trial) const;
  // How long the trials that are not done take, at the pace of those that a session has presented
  // in so many seconds. Unset before the third, and where procedures may need fewer.
  std::optional<double> left_s(double presented_in_s, int presented) const;

 private:
  struct Counts {
    int total{};
    int done{};
    bool is_open_ended{};
  };
  struct Kind {
    bool is_practice{};
    bool may_end_early{};
  };
  std::map<std::string, Kind> kinds_;  // by block
  Counts practice_;
  Counts counted_;
  int waiting_that_may_end_early_{};
};
}  // namespace tapstudy::runner
