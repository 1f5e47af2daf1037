#pragma once
#include <string>

#include "runner/trial_loop/exploration.hpp"
namespace tapstudy::runner {
// An exploration on top of another: what is not overridden, the inner one does.
class ForwardedExploration : public Exploration {
 public:
  explicit ForwardedExploration(Exploration& inner) : inner_{inner} {}
  void switch_to(std::size_t alternative) override { inner().switch_to(alternative); }
  std::size_t current() const override { return inner().current(); }
  void pass_time(double seconds) override { inner().pass_time(seconds); }
  bool is_running() const override { return inner().is_running(); }
  bool is_rendering() const override { return inner().is_rendering(); }
  double time_s() const override { return inner().time_s(); }
  void adjust(std::size_t setting) override { inner().adjust(setting); }
  std::size_t setting() const override { return inner().setting(); }
  void silence(bool is_silent) override { inner().silence(is_silent); }
  bool is_as_asked() const override { return inner().is_as_asked(); }
  const IntervalState* intervals() const override { return inner().intervals(); }
  void replay() override { inner().replay(); }
  void enter_answer(const std::string& answer) override { inner().enter_answer(answer); }
  int contacts(std::size_t alternative) const override { return inner().contacts(alternative); }

 protected:
  Exploration& inner() const { return inner_; }

 private:
  Exploration& inner_;
};
}  // namespace tapstudy::runner
