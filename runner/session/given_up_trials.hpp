#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "results/store.hpp"
namespace tapstudy::runner {
// The trials that ended without an answer and do not come again: skipped by the operator, but for
// those of procedures, or timed out (at_limit: give_up).
std::vector<int> given_up_trials(const protocols::Protocol& protocol,
                                 const std::string& participant_id, results::Store& store);
// Those that were never presented, because their block's criterion was met before, or its
// procedures were finished.
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
}  // namespace tapstudy::runner
