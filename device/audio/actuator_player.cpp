#include "device/audio/actuator_player.hpp"

#include <chrono>
#include <cmath>
#include <utility>

#include "device/audio/pace.hpp"
#include "device/loop/realtime.hpp"
namespace tapstudy::device {
namespace {
std::int64_t now_ns() noexcept {
  return std::chrono::nanoseconds{std::chrono::steady_clock::now().time_since_epoch()}.count();
}

// Half a minute at 1 kHz and 48 kHz, should the disk stall.
constexpr std::size_t tape_periods = 1U << 15U;
constexpr std::size_t tape_samples = 1U << 21U;
}  // namespace

double actuator_delay_s(const PcmSink& sink) {
  return static_cast<double>(sink.buffer_frames() + sink.period_frames()) / sink.rate_hz();
}

ActuatorPlayer::ActuatorPlayer(std::unique_ptr<PcmSink> sink, const Settings& settings)
    : sink_{std::move(sink)},
      realtime_{settings.realtime},
      max_gaps_{settings.max_gaps},
      delay_s_{actuator_delay_s(*sink_)},
      full_scale_n_{settings.full_scale_n},
      tape_{settings.is_recorded ? std::make_unique<core::ActuatorTape>(tape_periods, tape_samples)
                                 : nullptr},
      clock_{sink_->rate_hz(), static_cast<double>(sink_->period_frames())},
      period_(sink_->period_frames()),
      source_{
          {sink_->rate_hz(), settings.full_scale_n, settings.limits, settings.tick_s, delay_s_}},
      thread_{[this] { run(); }} {}

ActuatorPlayer::~ActuatorPlayer() {
  is_ending_ = true;
  thread_.join();
}

void ActuatorPlayer::begin(std::span<core::ActuatorVoice> voices) {
  const std::lock_guard lock{mutex_};
  if (tape_) {
    tape_->begin();
  }
  trial_ = ++trials_;
  actuated_.before = source_.before();
  source_.use(voices);
  actuated_.underruns = 0;
  note_fault();
}

Actuated ActuatorPlayer::end() {
  // a card that takes nothing has no end to wait for
  constexpr std::chrono::milliseconds longer_than_a_card_waits{250};
  std::unique_lock lock{mutex_};
  const std::int64_t noted = noted_;
  played_.wait_for(lock, longer_than_a_card_waits + std::chrono::duration<double>{delay_s_},
                   [&] { return actuated_.loss || trial_ == 0 || (noted_ > noted && is_done_); });
  if (trial_ != 0) {
    actuated_.limited = source_.limited();
    actuated_.ticks_lost = source_.ticks_lost();
    source_.use({});
    trial_ = 0;
  }
  return actuated_;
}

std::optional<AudioLoss> ActuatorPlayer::loss() {
  const std::lock_guard lock{mutex_};
  return actuated_.loss;
}

void ActuatorPlayer::run() {
  ask_for_realtime(realtime_);
  sink_->begin();
  Pace pace{*sink_, fastest_card};
  bool is_lost = false;
  while (!is_ending_ && !is_lost) {
    play(now_ns());
    is_lost = loss().has_value();
    pace.wait_after(period_.size());
  }
  sink_->end();
}

void ActuatorPlayer::play(std::int64_t now) {
  const double frame_ns = 1e9 / sink_->rate_hz();
  const auto ahead = static_cast<double>(sink_->delay_frames().value_or(0));
  clock_.measured(static_cast<double>(now) + ahead * frame_ns);
  core::ActuatorPeriod period{.heard_at_ns = std::llround(clock_.first_frame_ns()),
                              .frame_ns = clock_.frame_ns(),
                              .filled_at_ns = now};
  std::int64_t trial = 0;
  {
    const std::lock_guard lock{mutex_};
    source_.fill(period_, period.heard_at_ns, period.frame_ns, now);
    period.ticks = source_.ticks_taken();
    trial = trial_;
  }
  const PcmOutcome outcome = sink_->write(period_);
  if (outcome != PcmOutcome::played) {
    clock_.restart();
  }
  note(outcome, period, trial);
  played_.notify_all();
}

// A period of a trial, unless that has ended since.
void ActuatorPlayer::note(PcmOutcome outcome, core::ActuatorPeriod period, std::int64_t trial) {
  const std::lock_guard lock{mutex_};
  if (tape_ && trial != 0 && trial == trial_) {
    period.follows_gap = outcome == PcmOutcome::underrun;
    period.is_heard = outcome == PcmOutcome::played || period.follows_gap;
    tape_->push(period, period_);
  }
  ++noted_;
  is_done_ = source_.is_done();
  actuated_.note(outcome, *sink_);
  actuated_.rate_error = clock_.rate_error();
  actuated_.jitter_s = clock_.jitter_s();
  note_fault();
}

void ActuatorPlayer::note_fault() {
  using enum core::TickFault;
  const bool has_too_many_gaps = actuated_.underruns > max_gaps_;
  fault_.store(actuated_.loss      ? actuator_lost
               : has_too_many_gaps ? actuator_gaps
                                   : none,
               std::memory_order_release);
}
}  // namespace tapstudy::device
