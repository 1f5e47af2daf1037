#include "runner/session/given_up_trials.hpp"
namespace tapstudy::runner {
std::vector<int> given_up_trials(const protocols::Protocol& protocol,
                                 const std::string& participant_id, results::Store& store) {
  std::vector<int> given_up;
  for (const results::UnansweredTrial& trial : store.unanswered_trials(participant_id)) {
    if (trial.is_skipped ||
        protocol.block(trial.block).explore.at_limit == protocols::AtLimit::give_up) {
      given_up.push_back(trial.number);
    }
  }
  return given_up;
}
}  // namespace tapstudy::runner
