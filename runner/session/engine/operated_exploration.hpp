#pragma once
#include <optional>
#include <utility>

#include "runner/session/operators/operator.hpp"
#include "runner/session/trial_loop/exploration.hpp"
namespace tapstudy::runner {
// An exploration that the operator can end, or switch to another alternative.
class OperatedExploration final : public ForwardedExploration {
 public:
  OperatedExploration(Exploration& inner, Operator& by)
      : ForwardedExploration{inner}, operator_{by} {}
  // Called continually while anybody waits, so the operator's switches are made here.
  bool is_running() const override {
    if (const auto alternative = operator_.take_switch()) {
      inner().switch_to(*alternative);
    }
    if (std::exchange(told_, current()) != current()) {
      operator_.alternative_is_selected(told_);
    }
    if (!ended_by_operator_ && operator_.wants_trial_over()) {
      ended_by_operator_ = EndedByOperator{operator_.request(), operator_.is_paused()};
    }
    return inner().is_running() && !ended_by_operator_;
  }
  // A request is taken as it was when it ended the exploration, whatever the operator wants since.
  struct EndedByOperator {
    std::optional<TrialRequest> request;
    bool is_paused{};
  };
  const std::optional<EndedByOperator>& ended_by_operator() const { return ended_by_operator_; }

 private:
  Operator& operator_;
  mutable std::size_t told_{0};
  mutable std::optional<EndedByOperator> ended_by_operator_;
};
}  // namespace tapstudy::runner
