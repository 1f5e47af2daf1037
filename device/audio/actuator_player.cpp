#include "device/audio/actuator_player.hpp"

#include <chrono>
#include <utility>

#include "device/audio/pace.hpp"
#include "device/loop/realtime.hpp"
namespace tapstudy::device {
namespace {
std::int64_t now_ns() noexcept {
  return std::chrono::nanoseconds{std::chrono::steady_clock::now().time_since_epoch()}.count();
}
}  // namespace

double actuator_delay_s(const PcmSink& sink) {
  return static_cast<double>(sink.buffer_frames() + sink.period_frames()) / sink.rate_hz();
}

ActuatorPlayer::ActuatorPlayer(std::unique_ptr<PcmSink> sink, const Settings& settings)
    : sink_{std::move(sink)},
      realtime_{settings.realtime},
      max_gaps_{settings.max_gaps},
      delay_s_{actuator_delay_s(*sink_)},
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
  source_.use(voices);
  actuated_.underruns = 0;
  note_fault();
}

Actuated ActuatorPlayer::end() {
  // a card that takes nothing has no end to wait for
  constexpr std::chrono::milliseconds longer_than_a_card_waits{250};
  std::unique_lock lock{mutex_};
  played_.wait_for(lock, longer_than_a_card_waits + std::chrono::duration<double>{delay_s_},
                   [this] { return actuated_.loss || source_.is_done(); });
  actuated_.limited = source_.limited();
  source_.use({});
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
  {
    const std::lock_guard lock{mutex_};
    source_.fill(period_, clock_.first_frame_ns(), clock_.frame_ns(), now);
  }
  const PcmOutcome outcome = sink_->write(period_);
  if (outcome != PcmOutcome::played) {
    clock_.restart();
  }
  note(outcome);
  played_.notify_all();
}

void ActuatorPlayer::note(PcmOutcome outcome) {
  const std::lock_guard lock{mutex_};
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
