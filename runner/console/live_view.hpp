#pragma once
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "core/haptic_state.hpp"
namespace tapstudy::runner {
// What a screen shows of the running loop. Written by the recorder's thread, which drains the
// haptic thread's ring anyway; read by the server's threads. The haptic thread knows nothing of it.
class LiveView {
 public:
  struct Pointer {
    core::Vec3 position_m{core::Vec3::Zero()};  // device frame
    bool is_touching{};
    std::uint8_t alternative{};
    std::int64_t tick{-1};  // since the session's begin; -1: none yet
  };
  struct Step {                               // of step_s
    double force_n{};                         // magnitude: the largest
    core::Vec3 lowest_m{core::Vec3::Zero()};  // device frame: where the hand was lowest
    double interval_s{};                      // between the beginnings of two ticks: the longest
  };
  static constexpr double step_s = 0.01;
  struct Steps {
    std::int64_t end{};  // of the session's steps
    std::vector<Step> steps;
  };
  struct Totals {
    std::int64_t ticks{};
    std::int64_t late{};
    int contacts{};  // of the running trial
  };

  void begin_trial();
  void add(const core::TraceSample& sample);
  Pointer pointer() const;
  Totals totals() const;
  // Those after `begin`, as far as they are kept (some seconds).
  Steps since(std::int64_t begin) const;

 private:
  mutable std::mutex mutex_;
  Pointer pointer_;
  Totals totals_;
  bool was_touching_{false};
  std::optional<std::int64_t> last_tick_ns_;  // of this trial
  std::int64_t step_ends_ns_{0};
  bool has_step_{false};
  Step step_;
  std::int64_t ended_steps_{0};
  std::vector<Step> ring_;
};
}  // namespace tapstudy::runner
