#pragma once
#include <string>
#include <utility>

#include "protocols/schedule/schedule.hpp"
#include "runner/session/engine/session_states.hpp"
#include "runner/session/trial_loop/exploration.hpp"
namespace tapstudy::runner {
// An exploration in which each answer that is entered, changed or withdrawn before one is confirmed
// is a state of the session; its detail is the response as it would be stored.
class AnsweringExploration final : public ForwardedExploration {
 public:
  AnsweringExploration(Exploration& inner, SessionStates& states,
                       const protocols::PlannedTrial& trial, const protocols::Block& block)
      : ForwardedExploration{inner}, states_{states}, trial_{trial}, block_{block} {}
  void enter_answer(const std::string& answer) override {
    if (std::exchange(entered_, answer) != answer) {
      states_.enter(SessionState::answering, trial_.number,
                    answer.empty() ? "" : trial_.task->response(trial_, block_, answer));
    }
  }

 private:
  SessionStates& states_;
  const protocols::PlannedTrial& trial_;
  const protocols::Block& block_;
  std::string entered_;
};
}  // namespace tapstudy::runner
