#pragma once
#include <algorithm>
#include <optional>

#include "protocols/protocol.hpp"
#include "runner/session/participants/participant.hpp"
#include "runner/session/trial_loop/exploration.hpp"
namespace tapstudy::runner {
// Why an answer given now would be too early; nullopt: it is not.
std::optional<TooEarly> too_early(const TrialPrompt& prompt, const std::string& answer,
                                  const Exploration& exploration);

// An exploration that ends once the block's time is up.
class LimitedExploration final : public ForwardedExploration {
 public:
  LimitedExploration(Exploration& inner, const protocols::ExploreLimits& limits)
      : ForwardedExploration{inner}, limits_{limits} {}
  void pass_time(double seconds) override {
    const double left_s = limits_.max_seconds ? *limits_.max_seconds - time_s() : seconds;
    inner().pass_time(std::clamp(seconds, 0.0, std::max(0.0, left_s)));
  }
  bool is_running() const override { return inner().is_running() && !is_over(); }
  bool is_over() const { return limits_.max_seconds && time_s() >= *limits_.max_seconds; }

 private:
  const protocols::ExploreLimits& limits_;
};
}  // namespace tapstudy::runner
