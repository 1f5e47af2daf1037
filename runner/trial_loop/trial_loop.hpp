#pragma once
#include <span>

#include "core/tick/tap_renderer.hpp"
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

// Runs the haptic loop over some alternatives while somebody explores them.
class TrialLoop {
 public:
  virtual ~TrialLoop() = default;
  virtual TrialResult run(std::span<core::TapRenderer> alternatives, const Explore& explore) = 0;
  // Whether the device is known to exert no force after the latest run.
  virtual bool is_force_off() const { return true; }
};
}  // namespace tapstudy::runner
