#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/haptic_state.hpp"
namespace tapstudy::analysis {
// One tick of a tap: forces on the finger along the outward normal [N].
struct TracedTick {
  core::ForceParts parts{};  // before the limiter
  double commanded_n{};      // magnitude of the commanded force, after the limiter
  double reported_n{};       // magnitude of the force that the device reports; NaN: it does not
  bool is_touching{};
};

// A tap as it was felt. ticks[k] is k periods of the loop after the impact: where ticks were
// skipped the force of the tick before, which the device held. Out of contact forces are zero.
struct TracedTap {
  std::array<double, 3> position_m{};  // of the hand at the impact, device frame
  double speed_m_s{};                  // along the normal, towards the plate
  std::uint8_t alternative{};          // that was rendered, from 0
  std::vector<TracedTick> ticks;       // never empty
};

// What a tap is.
struct TapWindow {
  double rate_hz{1000.0};
  double length_s{0.2};    // from its impact on; shorter where the next tap begins before
  double rebound_s{0.05};  // an impact so soon after the finger came off belongs to the tap before
  std::size_t ticks() const { return static_cast<std::size_t>(length_s * rate_hz + 0.5); }
};

// Cuts the taps out of traces, sample by sample: holds one tap at a time. A tap ends at the end of
// its window, at the next tap, at a switch to another alternative, at a fault and with its trial.
class TapCutter {
 public:
  using Take = std::function<void(const TracedTap&)>;
  TapCutter(const TapWindow& window, Take take);
  // Samples of one trial, in order.
  void add(const core::TraceSample& sample);
  void end_trial();

 private:
  bool begins_tap(const core::TraceSample& sample) const;
  void begin(const core::TraceSample& sample);
  void continue_with(const core::TraceSample& sample);
  void finish();

  TapWindow window_;
  Take take_;
  TracedTap tap_;              // without ticks: none is under way
  std::int64_t impact_ns_{};   // of the tap
  std::int64_t release_ns_{};  // the first tick without contact since the last one in contact
  bool was_touching_{};
  bool has_touched_{};  // since the trial began, or the switch
  std::uint8_t alternative_{};
};
}  // namespace tapstudy::analysis
