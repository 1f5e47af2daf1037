#pragma once
#include <functional>
#include <span>
#include <utility>

#include "core/tick/tap_renderer.hpp"
#include "device/haptic_loop.hpp"
#include "device/realtime.hpp"
#include "results/recorder.hpp"
#include "results/trace_collector.hpp"
namespace tapstudy::runner {
// What a participant can do while a trial's alternatives are rendered.
class Exploration {
 public:
  virtual ~Exploration() = default;
  virtual void switch_to(std::size_t alternative) = 0;
  // Lets the trial run on; returns early if it has ended by a fault.
  virtual void pass_time(double seconds) = 0;
  virtual bool is_running() const = 0;
  virtual double time_s() const = 0;  // since the trial began
};
using Explore = std::function<void(Exploration&)>;

// All that one trial's loop left behind.
struct Presented {
  results::TraceCollector::Collected trace;
  device::LoopReport loop;
  std::int64_t dropped_samples{};
};

// Runs the haptic loop over some alternatives while somebody explores them.
class Presenter {
 public:
  virtual ~Presenter() = default;
  virtual Presented present(std::span<core::TapRenderer> alternatives, const Explore& explore) = 0;
};

enum class Keep { trace, nothing };

// In virtual time: the loop advances only while the explorer lets time pass, on one thread.
class VirtualPresenter final : public Presenter {
 public:
  VirtualPresenter(device::Device& device, device::LoopSettings settings, Keep keep = Keep::trace)
      : device_{device}, settings_{std::move(settings)}, keep_{keep} {}
  Presented present(std::span<core::TapRenderer> alternatives, const Explore& explore) override;

 private:
  device::Device& device_;
  device::LoopSettings settings_;
  Keep keep_;
};

// In real time: the loop runs on its own thread, the recorder empties its ring.
class LivePresenter final : public Presenter {
 public:
  LivePresenter(device::Device& device, device::LoopSettings settings,
                const device::RealtimeRequest& realtime, results::Recorder& recorder)
      : device_{&device},
        settings_{std::move(settings)},
        realtime_{realtime},
        recorder_{recorder} {}
  // From the next trial on.
  void use(device::Device& device) { device_ = &device; }
  Presented present(std::span<core::TapRenderer> alternatives, const Explore& explore) override;

 private:
  device::Device* device_;
  device::LoopSettings settings_;
  device::RealtimeRequest realtime_;
  results::Recorder& recorder_;
};
}  // namespace tapstudy::runner
