#pragma once
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "core/settings/device_settings.hpp"
#include "core/tick/actuator_tape.hpp"
#include "device/audio/actuator_source.hpp"
#include "device/audio/pcm.hpp"
#include "device/audio/sample_clock.hpp"
#include "device/loop/haptic_loop.hpp"
namespace tapstudy::device {
// What became of the actuator's samples since the latest begin(); the clock's, of the session.
struct Actuated : PlayedPeriods {
  ActuatorSource::Before before{};   // the trial
  std::int64_t limited{};            // samples that the limits changed
  std::int64_t ticks_lost{};         // of the loop
  double rate_error{};               // of the card, against the loop's clock
  std::optional<double> jitter_s{};  // of the measured times of its periods; as SampleClock
};

// A card's period, as short as ALSA's cards take, and a buffer of as few of them as a desktop plays
// without a gap.
inline constexpr double actuator_period_s = 0.001;
inline constexpr int actuator_buffer_periods = 3;

// From a tick of the haptic loop to its sound, always: the time in which the card plays a buffer
// and a period.
double actuator_delay_s(const PcmSink& sink);

// Plays a trial's actuator voices through a card on a thread of its own, silence between trials, so
// that the card's clock stays known.
class ActuatorPlayer {
 public:
  struct Settings {
    double full_scale_n{};
    core::ActuatorLimits limits;
    double tick_s{};  // of the haptic loop
    int max_gaps{};   // in a trial; more are a fault of it
    core::RealtimeRequest realtime;
    bool is_recorded{false};
  };
  ActuatorPlayer(std::unique_ptr<PcmSink> sink, const Settings& settings);
  ~ActuatorPlayer();
  ActuatorPlayer(const ActuatorPlayer&) = delete;
  ActuatorPlayer& operator=(const ActuatorPlayer&) = delete;
  ActuatorPlayer(ActuatorPlayer&&) = delete;
  ActuatorPlayer& operator=(ActuatorPlayer&&) = delete;

  // Of the haptic loop.
  ActuatorLink link() noexcept { return {&source_.ticks(), &fault_}; }
  // What is played in each trial, from begin() to end(); nullptr: it is not recorded.
  core::ActuatorTape* tape() noexcept { return tape_.get(); }
  // The alternatives of a trial, which must outlive it.
  void begin(std::span<core::ActuatorVoice> voices);
  // Returns when all is heard of a loop that has ended in order, at once after another; the voices
  // are not used any more.
  Actuated end();
  std::optional<AudioLoss> loss();
  double rate_hz() const { return sink_->rate_hz(); }
  double delay_s() const { return delay_s_; }
  double full_scale_n() const { return full_scale_n_; }

 private:
  void run();
  void play(std::int64_t now_ns);
  void note(PcmOutcome outcome, core::ActuatorPeriod period, std::int64_t trial);
  void note_fault();

  std::unique_ptr<PcmSink> sink_;
  core::RealtimeRequest realtime_;
  int max_gaps_;
  double delay_s_;
  double full_scale_n_;
  std::unique_ptr<core::ActuatorTape> tape_;
  SampleClock clock_;  // the thread's, like the period
  std::vector<float> period_;
  std::mutex mutex_;  // of what follows; held for as long as a period takes to compute
  std::condition_variable played_;  // a period
  ActuatorSource source_;
  Actuated actuated_;
  std::int64_t trials_{0};
  std::int64_t trial_{0};  // of those; 0: none now
  std::int64_t noted_{0};  // periods
  bool is_done_{true};     // the source, after the latest of them
  std::atomic<core::TickFault> fault_{core::TickFault::none};  // of the trial
  std::atomic<bool> is_ending_{false};
  std::thread thread_;
};
}  // namespace tapstudy::device
