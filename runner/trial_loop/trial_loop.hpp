#pragma once
#include <optional>
#include <span>

#include "core/tick/tap_renderer.hpp"
#include "device/hand/scripted_hand.hpp"
#include "device/loop/haptic_loop.hpp"
#include "results/trace_collector.hpp"
#include "runner/trial_loop/exploration.hpp"
namespace tapstudy::runner {
// The results of one trial's haptic loop.
struct TrialResult {
  results::TraceCollector::Collected trace;
  device::LoopReport loop;
  std::int64_t dropped_samples{};
};

// What a trial's haptic loop renders, and to whose taps: the hand's at the device or scripted ones.
struct Rendered {
  std::span<core::TapRenderer> alternatives;
  std::optional<device::RepeatedTap> scripted{};
};

// Runs the haptic loop over some alternatives while somebody explores them.
class TrialLoop {
 public:
  virtual ~TrialLoop() = default;
  virtual TrialResult run(const Rendered& rendered, const Explore& explore) = 0;
  // Whether the device is known to exert no force after the latest run.
  virtual bool is_force_off() const { return true; }
};

// The hand that makes a trial's scripted taps, if they are.
std::optional<device::ScriptedHand> scripted_hand(const Rendered& rendered,
                                                  const device::LoopSettings& settings);
}  // namespace tapstudy::runner
