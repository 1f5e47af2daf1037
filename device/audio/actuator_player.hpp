#pragma once
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "core/settings/device_settings.hpp"
#include "device/audio/actuator_source.hpp"
#include "device/audio/pcm.hpp"
#include "device/audio/sample_clock.hpp"
namespace tapstudy::device {
// What became of the actuator's samples since the latest begin(); the clock's, of the session.
struct Actuated : PlayedPeriods {
  std::int64_t limited{};  // samples that the limits changed
  double rate_error{};     // of the card, against the loop's clock
  double jitter_s{};       // of the measured times of its periods
};

// Plays a trial's actuator voices through a card on a thread of its own, silence between trials, so
// that the card's clock stays known. What a tick of the haptic loop excites is heard delay_s()
// later, always: the time in which a buffer and a period are played.
class ActuatorPlayer {
 public:
  struct Settings {
    double full_scale_n{};
    core::ActuatorLimits limits;
    double tick_s{};  // of the haptic loop
    core::RealtimeRequest realtime;
  };
  ActuatorPlayer(std::unique_ptr<PcmSink> sink, const Settings& settings);
  ~ActuatorPlayer();
  ActuatorPlayer(const ActuatorPlayer&) = delete;
  ActuatorPlayer& operator=(const ActuatorPlayer&) = delete;
  ActuatorPlayer(ActuatorPlayer&&) = delete;
  ActuatorPlayer& operator=(ActuatorPlayer&&) = delete;

  // Of the haptic loop.
  core::SpscRing<core::ActuatorTick>& ticks() noexcept { return source_.ticks(); }
  // The alternatives of a trial, which must outlive it.
  void begin(std::span<core::ActuatorVoice> voices);
  // The voices are not used any more; what was heard of them fades.
  Actuated end();
  std::optional<AudioLoss> loss();
  double rate_hz() const { return sink_->rate_hz(); }
  double delay_s() const { return delay_s_; }

 private:
  void run();
  void play(std::int64_t now_ns);
  void note(PcmOutcome outcome);

  std::unique_ptr<PcmSink> sink_;
  core::RealtimeRequest realtime_;
  double delay_s_;
  SampleClock clock_;  // the thread's, like the period
  std::vector<float> period_;
  std::mutex mutex_;  // of what follows; held for as long as a period takes to compute
  ActuatorSource source_;
  Actuated actuated_;
  std::atomic<bool> is_ending_{false};
  std::thread thread_;
};
}  // namespace tapstudy::device
