#pragma once
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/haptics/haptic_state.hpp"
#include "runner/session/operators/operator_desk.hpp"
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

struct MaskingInView {
  bool is_playing{};
  double level_db_fs{};
  std::int64_t underruns{};  // in this trial, or the last
};

struct SessionInView {
  std::string title;
  std::string participant_id;
  std::string mode;
  std::string device;
  bool is_blind{};
  std::string state;
  std::string last_fault;
  bool has_participant_page{};
  std::optional<MaskingInView> masking{};  // unset: the study has none
};

// For the operator's page.
std::string state_json(const SessionInView& session, const DeskView& desk,
                       const LiveView::Totals& totals);
// Heights are above that place along the device's normal.
std::string live_json(const LiveView::Steps& steps, const LiveView::Totals& totals,
                      double surface_along_normal_m, const core::Placement& placement);
std::string refusal_json(const std::string& why);
// Throws InvalidInput if there is none.
std::string command_in(const std::string& json);

// For the operator's terminal: what the operator's page shows, as lines of text.
std::string status_text(const SessionInView& session, const DeskView& desk,
                        const LiveView::Totals& totals);

// One line of the running loop: force and height (above that place along the device's normal) as
// small curves over these steps, with their extremes, and contacts and late ticks.
std::string live_line(const LiveView::Steps& steps, const LiveView::Totals& totals,
                      double surface_along_normal_m);
}  // namespace tapstudy::runner
