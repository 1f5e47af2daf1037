#pragma once
#include <optional>
#include <utility>

#include "runner/operators/operator.hpp"
#include "runner/trial_loop/exploration.hpp"
namespace tapstudy::runner {
// An exploration that the operator can end, or switch to another alternative.
class OperatedExploration final : public Exploration {
 public:
  OperatedExploration(Exploration& inner, Operator& by) : inner_{inner}, operator_{by} {}
  void switch_to(std::size_t alternative) override { inner_.switch_to(alternative); }
  std::size_t current() const override { return inner_.current(); }
  void adjust(std::size_t setting) override { inner_.adjust(setting); }
  std::size_t setting() const override { return inner_.setting(); }
  const IntervalState* intervals() const override { return inner_.intervals(); }
  void replay() override { inner_.replay(); }
  void pass_time(double seconds) override { inner_.pass_time(seconds); }
  // Called continually while anybody waits, so the operator's switches are made here.
  bool is_running() const override {
    if (const auto alternative = operator_.take_switch()) {
      inner_.switch_to(*alternative);
    }
    if (std::exchange(told_, inner_.current()) != inner_.current()) {
      operator_.alternative_is_selected(told_);
    }
    if (!ended_by_operator_ && operator_.wants_trial_over()) {
      ended_by_operator_ = EndedByOperator{operator_.request(), operator_.is_paused()};
    }
    return inner_.is_running() && !ended_by_operator_;
  }
  // A request is taken as it was when it ended the exploration, whatever the operator wants since.
  struct EndedByOperator {
    std::optional<TrialRequest> request;
    bool is_paused{};
  };
  const std::optional<EndedByOperator>& ended_by_operator() const { return ended_by_operator_; }
  bool is_rendering() const override { return inner_.is_rendering(); }
  double time_s() const override { return inner_.time_s(); }
  int contacts(std::size_t alternative) const override { return inner_.contacts(alternative); }

 private:
  Exploration& inner_;
  Operator& operator_;
  mutable std::size_t told_{0};
  mutable std::optional<EndedByOperator> ended_by_operator_;
};
}  // namespace tapstudy::runner
