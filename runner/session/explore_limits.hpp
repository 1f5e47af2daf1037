#pragma once
#include <algorithm>
#include <optional>

#include "protocols/protocol.hpp"
#include "runner/participants/participant.hpp"
#include "runner/trial_loop/exploration.hpp"
namespace tapstudy::runner {
// Why an answer given now would be too early; nullopt: it is not.
std::optional<TooEarly> too_early(const TrialPrompt& prompt, const std::string& answer,
                                  const Exploration& exploration);

// An exploration that ends once the block's time is up.
class LimitedExploration final : public Exploration {
 public:
  LimitedExploration(Exploration& inner, const protocols::ExploreLimits& limits)
      : inner_{inner}, limits_{limits} {}
  void switch_to(std::size_t alternative) override { inner_.switch_to(alternative); }
  std::size_t current() const override { return inner_.current(); }
  void adjust(std::size_t setting) override { inner_.adjust(setting); }
  std::size_t setting() const override { return inner_.setting(); }
  const IntervalState* intervals() const override { return inner_.intervals(); }
  void replay() override { inner_.replay(); }
  void pass_time(double seconds) override {
    const double left_s = limits_.max_seconds ? *limits_.max_seconds - time_s() : seconds;
    inner_.pass_time(std::clamp(seconds, 0.0, std::max(0.0, left_s)));
  }
  bool is_running() const override { return inner_.is_running() && !is_over(); }
  bool is_rendering() const override { return inner_.is_rendering(); }
  double time_s() const override { return inner_.time_s(); }
  int contacts(std::size_t alternative) const override { return inner_.contacts(alternative); }
  bool is_over() const { return limits_.max_seconds && inner_.time_s() >= *limits_.max_seconds; }

 private:
  Exploration& inner_;
  const protocols::ExploreLimits& limits_;
};
}  // namespace tapstudy::runner
