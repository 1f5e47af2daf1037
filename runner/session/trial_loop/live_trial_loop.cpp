#include "runner/session/trial_loop/live_trial_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "device/device.hpp"
#include "device/loop/realtime.hpp"
#include "runner/session/trial_loop/trial_loop.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
namespace {
constexpr std::size_t ring_capacity = 1U << 16U;  // a minute at 1 kHz, should the disk stall
constexpr std::chrono::milliseconds poll_interval{5};

class LiveExploration final : public LoopExploration {
 public:
  LiveExploration(device::HapticLoop& loop, device::TickClock& clock,
                  const std::atomic<bool>& has_ended)
      : LoopExploration{loop}, clock_{clock}, has_ended_{has_ended} {}
  void pass_time(double seconds) override {
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>{seconds};
    while (is_running() && std::chrono::steady_clock::now() < until) {
      std::this_thread::sleep_for(poll_interval);
    }
  }
  // Called continually by the trial's supervisor, so it also sends the loop's heartbeat.
  bool is_running() const override {
    loop().beat();
    return !has_ended_.load(std::memory_order_acquire);
  }
  bool is_rendering() const override { return is_running() && loop().is_ticking(clock_.now()); }
  // As the trace counts it: the thread's and the device's set-up are before the trial.
  double time_s() const override {
    const device::Nanoseconds began_at = loop().began_at();
    return began_at == 0 ? 0.0 : 1e-9 * static_cast<double>(clock_.now() - began_at);
  }

 private:
  device::TickClock& clock_;
  const std::atomic<bool>& has_ended_;
};

// RAII: the recorder follows the collector during this object's lifetime.
class Following {
 public:
  Following(results::Recorder& recorder, results::TraceCollector& collector) : recorder_{recorder} {
    recorder_.follow(collector);
  }
  ~Following() { recorder_.leave(); }
  Following(const Following& other) = delete;
  Following& operator=(const Following& other) = delete;

 private:
  results::Recorder& recorder_;
};
}  // namespace

namespace {
// RAII: the actuator renders a trial's voices during this object's lifetime.
class Actuating {
 public:
  Actuating(device::ActuatorPlayer* player, std::span<core::ActuatorVoice> voices)
      : player_{player} {
    if (player_ != nullptr) {
      player_->begin(voices);
    }
  }
  ~Actuating() {
    if (player_ != nullptr) {
      player_->end();
    }
  }
  // The trial is over: all is heard of it.
  std::optional<device::Actuated> end() const {
    return player_ == nullptr ? std::nullopt : std::optional{player_->end()};
  }
  void add_to(TrialResult& result, const device::Actuated& actuated,
              device::Nanoseconds began_at) const {
    if (const core::ActuatorTape* const tape = player_->tape()) {
      result.actuator = results::ActuatorRow{player_->rate_hz(),
                                             player_->delay_s(),
                                             player_->full_scale_n(),
                                             actuated.before.last_n,
                                             actuated.before.mean_square_n2,
                                             actuated.ticks_lost,
                                             tape->dropped()};
    }
    std::vector<results::EventRow>& events = result.trace.events;
    events.insert(events.begin(), {{0.0, "actuator", player_->delay_s()},
                                   {0.0, "actuator_rate_error", actuated.rate_error}});
    if (actuated.jitter_s) {
      events.insert(events.begin() + 1, {0.0, "actuator_jitter", *actuated.jitter_s});
    }
    if (actuated.underruns > 0) {
      events.push_back({0.0, "actuator_underrun", static_cast<double>(actuated.underruns)});
    }
    if (actuated.limited > 0) {
      events.push_back({0.0, "actuator_limited", static_cast<double>(actuated.limited)});
    }
    if (actuated.loss) {
      const std::chrono::nanoseconds at = actuated.loss->at.time_since_epoch();
      events.push_back(
          {std::max(0.0, 1e-9 * static_cast<double>(at.count() - began_at)), "actuator_lost", 0.0});
    }
  }
  Actuating(const Actuating& other) = delete;
  Actuating& operator=(const Actuating& other) = delete;
  Actuating(Actuating&&) = delete;
  Actuating& operator=(Actuating&&) = delete;

 private:
  device::ActuatorPlayer* player_;
};
}  // namespace

TrialResult LiveTrialLoop::run(const Rendered& rendered, const Explore& explore) {
  core::SpscRing<core::TraceSample> ring{ring_capacity};
  results::TraceCollector collector{ring};
  device::MonotonicClock clock;
  std::optional<device::ScriptedHand> taps = scripted_hand(rendered, settings_);
  device::HapticLoop loop{*device_, rendered.alternatives,  settings_, ring,
                          clock,    taps ? &*taps : nullptr};
  if (watch_) {
    collector.watch([&](const core::TraceSample& sample) {
      const std::chrono::nanoseconds since_boot{loop.began_at() + sample.t_ns};
      watch_(sample, std::chrono::steady_clock::time_point{since_boot});
    });
  }
  if (actuator_ != nullptr) {
    if (const auto loss = actuator_->loss()) {
      throw device::DeviceError{fmt::format("the actuator plays no more ({})", loss->why)};
    }
    loop.use(actuator_->link());
    if (core::ActuatorTape* const tape = actuator_->tape()) {
      collector.add(*tape, [&loop]() -> std::optional<std::int64_t> {
        const device::Nanoseconds began_at = loop.began_at();
        return began_at == 0 ? std::nullopt : std::optional{began_at};
      });
    }
  }
  const Actuating actuating{actuator_, rendered.voices};
  std::atomic<bool> has_ended{false};
  {
    const Following following{recorder_, collector};
    const std::jthread haptic_thread{[&](const std::stop_token& stop) {
      device::ask_for_realtime(realtime_);  // the outcome is in the session's row
      loop.run(stop);
      has_ended.store(true, std::memory_order_release);
    }};
    LiveExploration exploration{loop, clock, has_ended};
    explore(exploration);
  }  // the haptic thread has commanded zero force and ended
  stop_ = loop.report().stop;
  const std::optional<device::Actuated> actuated = actuating.end();
  TrialResult result{collector.finish(), loop.report(), static_cast<std::int64_t>(ring.dropped())};
  if (actuated) {
    actuating.add_to(result, *actuated, loop.began_at());
  }
  return result;
}

namespace {
using Clock = std::chrono::steady_clock;

// RAII: heard during this object's lifetime.
class Audible {
 public:
  explicit Audible(device::AudioPlayer& player) : player_{player} { player_.fade_in(); }
  ~Audible() { player_.fade_out(); }
  Audible(const Audible&) = delete;
  Audible& operator=(const Audible&) = delete;
  Audible(Audible&&) = delete;
  Audible& operator=(Audible&&) = delete;

 private:
  device::AudioPlayer& player_;
};

void add_events(const device::Played& played, double level_db_fs, Clock::time_point begun,
                std::vector<results::EventRow>& events) {
  const auto since_begin_s = [&](Clock::time_point time) {
    return std::max(0.0, std::chrono::duration<double>(time - begun).count());
  };
  events.insert(events.begin(), {0.0, "masking", level_db_fs});
  if (played.underruns > 0) {
    events.push_back({0.0, "masking_underrun", static_cast<double>(played.underruns)});
  }
  if (played.cut > 0) {
    events.push_back({0.0, "masking_cut", static_cast<double>(played.cut)});
  }
  if (played.loss) {
    events.push_back({since_begin_s(played.loss->at), "masking_lost", 0.0});
  }
}
}  // namespace

void MaskedTrialLoop::tell(bool is_heard, std::string_view state, const std::string& detail) const {
  if (is_heard && noise_.tell) {
    noise_.tell(state, detail);
  }
}

TrialResult MaskedTrialLoop::run(const Rendered& rendered, const Explore& explore) {
  if (const auto& loss = player_.played().loss; noise_.is_required && loss) {
    throw device::DeviceError{fmt::format(
        "masking noise is no longer played ({}), and the protocol requires it", loss->why)};
  }
  TrialResult result;
  device::Played played;
  bool has_begun = false;
  Clock::time_point begun;
  {
    const Audible audible{player_};
    has_begun = !player_.played().loss;
    tell(has_begun, "masking", fmt::format("{:.1f} dB FS", noise_.level_db_fs));
    begun = Clock::now();
    result = inner_.run(rendered, explore);
    played = player_.played();
    tell(has_begun, "masking_end", "");
  }
  if (has_begun) {
    add_events(played, noise_.level_db_fs, begun, result.trace.events);
  }
  if (played.loss && !has_warned_) {
    has_warned_ = true;
    warn(fmt::format("masking noise is no longer played ({}); {}", played.loss->why,
                     noise_.is_required ? "the session ends, since the protocol requires it"
                                        : "the session goes on without it"));
  }
  return result;
}
}  // namespace tapstudy::runner
