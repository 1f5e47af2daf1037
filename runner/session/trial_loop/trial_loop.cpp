#include "runner/session/trial_loop/trial_loop.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "device/audio/actuator_player.hpp"
#include "device/audio/actuator_source.hpp"
namespace tapstudy::runner {
std::optional<device::ScriptedHand> scripted_hand(const Rendered& rendered,
                                                  const device::LoopSettings& settings) {
  if (!rendered.scripted) {
    return std::nullopt;
  }
  return device::ScriptedHand{*rendered.scripted, settings.placement,
                              1e-9 * static_cast<double>(settings.period)};
}

namespace {
constexpr std::size_t slice_ticks = 1024;

// A card without jitter, whose clock is the loop's: each period is rendered a buffer before it is
// heard, as on a real one.
class VirtualActuator {
 public:
  VirtualActuator(const core::ActuatorOutput& actuator, double tick_s,
                  std::span<core::ActuatorVoice> voices)
      : rate_hz_{static_cast<double>(actuator.rate_hz)},
        full_scale_n_{actuator.full_scale_n},
        period_(static_cast<std::size_t>(std::llround(device::actuator_period_s * rate_hz_))),
        delay_s_{static_cast<double>(period_.size()) * (device::actuator_buffer_periods + 1) /
                 rate_hz_},
        source_{{rate_hz_, full_scale_n_, actuator.limits, tick_s, delay_s_}} {
    source_.use(voices);
  }
  device::ActuatorLink link() noexcept { return {&source_.ticks()}; }
  core::ActuatorTape& tape() noexcept { return tape_; }
  void play_until(std::int64_t now_ns) {
    while (next_ns() <= now_ns) {
      play_period();
    }
  }
  // What is still to be heard of a loop that has ended.
  void play_out() {
    while (!source_.is_done()) {
      play_period();
    }
  }
  void add_to(TrialResult& result) const {
    result.actuator = results::ActuatorRow{
        .rate_hz = rate_hz_, .delay_s = delay_s_, .full_scale_n = full_scale_n_};
    std::vector<results::EventRow>& events = result.trace.events;
    events.insert(events.begin(), {0.0, "actuator", delay_s_});
    if (source_.limited() > 0) {
      events.push_back({0.0, "actuator_limited", static_cast<double>(source_.limited())});
    }
  }

 private:
  static constexpr std::size_t tape_periods = 1U << 12U;

  std::int64_t ns_of(std::int64_t periods) const noexcept {
    return std::llround(1e9 * static_cast<double>(periods) * static_cast<double>(period_.size()) /
                        rate_hz_);
  }
  std::int64_t next_ns() const noexcept { return ns_of(played_); }
  void play_period() {
    core::ActuatorPeriod period{.heard_at_ns = ns_of(played_ + device::actuator_buffer_periods),
                                .frame_ns = 1e9 / rate_hz_,
                                .filled_at_ns = next_ns(),
                                .is_heard = true};
    source_.fill(period_, period.heard_at_ns, period.frame_ns, period.filled_at_ns);
    period.ticks = source_.ticks_taken();
    tape_.push(period, period_);
    ++played_;
  }

  double rate_hz_;
  double full_scale_n_;
  std::vector<float> period_;
  double delay_s_;
  device::ActuatorSource source_;
  core::ActuatorTape tape_{tape_periods, tape_periods* period_.size()};
  std::int64_t played_{0};  // periods
};

class VirtualExploration final : public LoopExploration {
 public:
  using PlayUntilNow = std::function<void()>;  // empty: there is no actuator
  VirtualExploration(device::HapticLoop& loop, results::TraceCollector& collector, double period_s,
                     Keep keep, PlayUntilNow play)
      : LoopExploration{loop},
        collector_{collector},
        period_s_{period_s},
        keep_{keep},
        play_{std::move(play)} {}
  void pass_time(double seconds) override {
    auto left = static_cast<std::int64_t>(std::llround(seconds / period_s_));
    while (left > 0 && is_running()) {
      const std::int64_t slice = play_ ? 1 : std::min<std::int64_t>(left, slice_ticks);
      loop().run_ticks(slice);
      if (play_) {
        play_();
      }
      keep_ == Keep::nothing ? collector_.discard() : collector_.drain();
      left -= slice;
    }
  }
  bool is_running() const override { return loop().report().stopped_by == core::TickFault::none; }
  bool is_rendering() const override { return is_running(); }
  double time_s() const override { return static_cast<double>(loop().report().ticks) * period_s_; }

 private:
  results::TraceCollector& collector_;
  double period_s_;
  Keep keep_;
  PlayUntilNow play_;
};
}  // namespace

TrialResult VirtualTrialLoop::run(const Rendered& rendered, const Explore& explore) {
  core::SpscRing<core::TraceSample> ring{slice_ticks};
  results::TraceCollector collector{
      ring, keep_ == Keep::events ? results::Traced::events_only : results::Traced::whole};
  device::VirtualClock clock;
  std::optional<device::ScriptedHand> taps = scripted_hand(rendered, settings_);
  device::HapticLoop loop{device_, rendered.alternatives,  settings_, ring,
                          clock,   taps ? &*taps : nullptr};
  std::optional<VirtualActuator> actuator;
  VirtualExploration::PlayUntilNow play;
  if (actuator_ != nullptr && keep_ == Keep::trace && !rendered.voices.empty()) {
    actuator.emplace(*actuator_, tick_s_, rendered.voices);
    loop.use(actuator->link());
    collector.add(actuator->tape(), [] { return 0; });
    play = [&] { actuator->play_until(clock.now()); };
  }
  VirtualExploration exploration{loop, collector, 1e-9 * static_cast<double>(settings_.period),
                                 keep_, std::move(play)};
  explore(exploration);
  loop.zero_force();
  if (actuator) {
    actuator->play_out();
  }
  TrialResult result{collector.finish(), loop.report(), static_cast<std::int64_t>(ring.dropped())};
  if (actuator) {
    actuator->add_to(result);
  }
  return result;
}
}  // namespace tapstudy::runner
