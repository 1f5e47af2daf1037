#pragma once
#include <optional>
#include <span>
#include <utility>

#include "core/settings/actuator_settings.hpp"
#include "core/tick/actuator_voice.hpp"
#include "core/tick/tap_renderer.hpp"
#include "device/hand/scripted_hand.hpp"
#include "device/loop/haptic_loop.hpp"
#include "results/traces/trace_collector.hpp"
#include "runner/session/trial_loop/exploration.hpp"
namespace tapstudy::runner {
// The results of one trial's haptic loop.
struct TrialResult {
  results::TraceCollector::Collected trace;
  device::LoopReport loop;
  std::int64_t dropped_samples{};
  std::optional<results::ActuatorRow> actuator{};  // of trace.actuator
};

// A trial's haptic loop renders these, to the taps of the hand at the device or to scripted ones,
// and an actuator beside it its share of them, if there is one.
struct Rendered {
  std::span<core::TapRenderer> alternatives;
  std::optional<device::RepeatedTap> scripted{};
  std::span<core::ActuatorVoice> voices{};
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

// An exploration by means of the haptic loop, whatever its clock.
class LoopExploration : public Exploration {
 public:
  // The loop must outlive it.
  explicit LoopExploration(device::HapticLoop& loop) : loop_{loop} {}
  void request_position(std::size_t position) override { loop_.request_alternative(position); }
  void request_silence(bool is_silent) override { loop_.request_silence(is_silent); }
  bool is_as_requested() const override { return loop_.is_as_requested(); }
  int contacts(std::size_t position) const override { return loop_.contacts(position); }

 protected:
  device::HapticLoop& loop() const { return loop_; }

 private:
  device::HapticLoop& loop_;
};

enum class Keep { trace, events, nothing };

// In virtual time: the loop advances only while the explorer lets time pass, on one thread.
class VirtualTrialLoop final : public TrialLoop {
 public:
  VirtualTrialLoop(device::Device& device, device::LoopSettings settings, Keep keep = Keep::trace)
      : device_{device}, settings_{std::move(settings)}, keep_{keep} {}
  // What it plays is rendered and kept with each trace. tick_s: of the loop.
  void use(const core::ActuatorOutput& actuator, double tick_s) {
    actuator_ = &actuator;
    tick_s_ = tick_s;
  }
  TrialResult run(const Rendered& rendered, const Explore& explore) override;

 private:
  device::Device& device_;
  device::LoopSettings settings_;
  Keep keep_;
  const core::ActuatorOutput* actuator_{nullptr};
  double tick_s_{};
};
}  // namespace tapstudy::runner
