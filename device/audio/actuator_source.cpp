#include "device/audio/actuator_source.hpp"

#include <algorithm>
#include <cmath>
namespace tapstudy::device {
namespace {
constexpr std::size_t ring_capacity = 1024;
constexpr double bridge_s = 1e-3;
// Ticks are taken once a period of the card, of a millisecond or so.
constexpr double least_without_tick_s = 0.002;
constexpr double most_periods_without_tick = 2.0;

// As many ticks as come within the delay, and as many again.
std::size_t waiting_capacity(const ActuatorSource::Settings& settings) {
  constexpr std::size_t least = 64;
  return std::max(least, 2 * static_cast<std::size_t>(settings.delay_s / settings.tick_s));
}
}  // namespace

ActuatorSource::ActuatorSource(const Settings& settings, const Before& before)
    : settings_{settings},
      delay_ns_{std::llround(1e9 * settings.delay_s)},
      ticks_{ring_capacity},
      waiting_(waiting_capacity(settings)),
      samples_a_tick_{
          static_cast<int>(std::max(1L, std::lround(settings.tick_s * settings.rate_hz)))},
      last_n_{before.last_n},
      limiter_{{std::min(settings.limits.peak_n, settings.full_scale_n), settings.limits.rms_n},
               1.0 / settings.rate_hz,
               before.mean_square_n2} {}

void ActuatorSource::use(std::span<core::ActuatorVoice> voices) noexcept {
  take_ticks();
  first_ = count_ = 0;  // of the trial before
  taken_ = 0;
  lost_before_ = ticks_.dropped();
  is_newest_last_ = false;
  heard_ = nullptr;
  voices_ = voices;
  limited_ = 0;
  bridge_gap();
}

void ActuatorSource::fill(std::span<float> samples, std::int64_t heard_at_ns, double frame_ns,
                          std::int64_t now_ns) noexcept {
  take_ticks();
  const double without_tick_s = 1e-9 * static_cast<double>(now_ns - newest_ns_);
  if (!is_newest_last_ && without_tick_s > std::max(least_without_tick_s,
                                                    most_periods_without_tick * settings_.tick_s)) {
    if (heard_ != nullptr && !has_faded_) {
      heard_->fade(static_cast<int>(samples.size()));
      has_faded_ = true;
    }
    first_ = count_ = 0;
  }
  double since_ns = 0.0;
  for (float& sample : samples) {
    const double wanted_n = next_force_n(heard_at_ns, since_ns);
    const double passed_n = limiter_.limited(wanted_n);
    limited_ += passed_n == wanted_n ? 0 : 1;
    sample = static_cast<float>(passed_n / settings_.full_scale_n);
    since_ns += frame_ns;
  }
}

std::int64_t ActuatorSource::ticks_lost() const noexcept {
  return static_cast<std::int64_t>(ticks_.dropped() - lost_before_);
}

bool ActuatorSource::is_done() noexcept {
  take_ticks();
  return voices_.empty() || !is_newest_last_ || (count_ == 0 && end_left_ == 0);
}

// What does not fit has waited for longer than the delay: the oldest is dropped.
void ActuatorSource::take_ticks() noexcept {
  core::ActuatorTick tick{};
  while (ticks_.try_pop(tick)) {
    ++taken_;
    newest_ns_ = tick.at_ns;
    is_newest_last_ = tick.is_last;
    if (count_ == waiting_.size()) {
      first_ = (first_ + 1) % waiting_.size();
      --count_;
    }
    waiting_[(first_ + count_++) % waiting_.size()] = tick;
  }
}

// Whether it is heard at this time since the period's first sample, or before; the same of times
// that count from another begin.
const core::ActuatorTick* ActuatorSource::due(std::int64_t heard_at_ns, double since_ns) noexcept {
  if (count_ == 0 ||
      static_cast<double>(waiting_[first_].at_ns + delay_ns_ - heard_at_ns) > since_ns) {
    return nullptr;
  }
  const core::ActuatorTick& tick = waiting_[first_];
  first_ = (first_ + 1) % waiting_.size();
  --count_;
  return &tick;
}

double ActuatorSource::next_force_n(std::int64_t heard_at_ns, double since_ns) noexcept {
  if (heard_ != nullptr) {
    heard_->advance();
  }
  end_left_ = std::max(0, end_left_ - 1);
  while (const core::ActuatorTick* const tick = due(heard_at_ns, since_ns)) {
    begin(*tick);
  }
  const double rendered_n = heard_ == nullptr ? 0.0 : heard_->force_n();
  if (bridge_left_ > 0) {
    bridged_n_ = --bridge_left_ == 0 ? 0.0 : bridged_n_ - bridge_step_n_;
  }
  last_n_ = rendered_n + bridged_n_;
  return last_n_;
}

void ActuatorSource::begin(const core::ActuatorTick& tick) noexcept {
  if (tick.alternative >= voices_.size()) {
    return;
  }
  core::ActuatorVoice* const voice = &voices_[tick.alternative];
  if (voice != heard_) {
    bridge_gap();
    voice->reset();
    heard_ = voice;
  }
  has_faded_ = false;
  end_left_ = tick.is_last ? samples_a_tick_ : 0;
  voice->begin(tick, samples_a_tick_);
}

void ActuatorSource::bridge_gap() noexcept {
  bridge_left_ = std::max(1, static_cast<int>(std::lround(bridge_s * settings_.rate_hz)));
  bridged_n_ = last_n_;
  bridge_step_n_ = last_n_ / bridge_left_;
}
}  // namespace tapstudy::device
