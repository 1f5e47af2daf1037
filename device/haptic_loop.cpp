#include "device/haptic_loop.hpp"

#include <algorithm>
#include <utility>
namespace tapstudy::device {
using core::TickFault;
namespace {
std::array<double, 3> as_array(const core::Vec3& v) noexcept {
  return {v.x(), v.y(), v.z()};
}
}  // namespace

HapticLoop::HapticLoop(Device& device, std::span<core::TapRenderer> alternatives,
                       LoopSettings settings, core::SpscRing<core::TraceSample>& trace,
                       TickClock& clock) noexcept
    : device_{device},
      alternatives_{alternatives},
      settings_{std::move(settings)},
      trace_{trace},
      clock_{clock},
      start_{clock.now()},
      deadline_{start_} {}

void HapticLoop::run(const std::stop_token& stop) noexcept {
  while (!stop.stop_requested() && step()) {
  }
  rest();
}

void HapticLoop::run_ticks(std::int64_t count) noexcept {
  while (count-- > 0 && step()) {
  }
}

void HapticLoop::rest() noexcept {
  static_cast<void>(device_.write(core::Vec3::Zero()));
}

bool HapticLoop::step() noexcept {
  if (report_.stopped_by != TickFault::none) {
    return false;
  }
  const Nanoseconds woke_at = clock_.wait_until(deadline_);
  note_lateness(woke_at);
  const core::TraceSample sample = tick(woke_at - start_);
  trace_.try_push(sample);
  ++report_.ticks;
  report_.saturated += sample.saturated ? 1 : 0;
  report_.stopped_by = sample.fault;
  if (sample.fault != TickFault::none) {
    rest();
  }
  return sample.fault == TickFault::none;
}

// A period that has passed is skipped, never caught up in a burst; the rhythm stays.
void HapticLoop::note_lateness(Nanoseconds woke_at) noexcept {
  const Nanoseconds lateness = woke_at - deadline_;
  const Nanoseconds missed = lateness / settings_.period;
  report_.worst_lateness = std::max(report_.worst_lateness, lateness);
  report_.late += lateness > settings_.period / 2 ? 1 : 0;
  report_.skipped += missed;
  deadline_ += (missed + 1) * settings_.period;
}

void HapticLoop::take_requested_alternative() noexcept {
  const std::size_t wanted = requested_.load(std::memory_order_acquire);
  if (wanted != current_ && !alternatives_[current_].is_touching()) {
    alternatives_[wanted].take_over_from(alternatives_[current_]);
    current_ = wanted;
  }
}

core::TraceSample HapticLoop::tick(Nanoseconds now) noexcept {
  take_requested_alternative();
  const double dt_s = 1e-9 * static_cast<double>(settings_.period);
  core::TraceSample sample{};
  sample.t_ns = now;
  sample.alternative = static_cast<std::uint8_t>(current_);
  core::HandState hand;
  if (device_.read(hand) == Io::failed) {
    sample.fault = TickFault::device_read;
    return sample;
  }
  const core::RenderedTick rendered =
      alternatives_[current_].tick(settings_.placement.to_plate(hand));
  const core::Vec3 wanted_n = core::Placement::force_to_device(rendered.force_n);
  const core::LimitedForce limited =
      core::limit_force(wanted_n, previous_force_n_, settings_.limits, dt_s);
  if (!limited.was_finite || !hand.position_m.allFinite() || !hand.velocity_m_s.allFinite()) {
    sample.fault = TickFault::non_finite_force;
    return sample;
  }
  if (device_.write(limited.force_n) == Io::failed) {
    sample.fault = TickFault::device_write;
  }
  previous_force_n_ = limited.force_n;
  sample.position_m = as_array(hand.position_m);
  sample.velocity_m_s = as_array(hand.velocity_m_s);
  sample.penetration_m = rendered.contact.penetration_m;
  sample.penalty_n = rendered.parts.penalty_n;
  sample.vibration_n = rendered.parts.vibration_n;
  sample.sinusoid_n = rendered.parts.sinusoid_n;
  sample.force_n = as_array(limited.force_n);
  sample.touching = rendered.contact.touching;
  sample.struck = rendered.contact.struck;
  sample.saturated = limited.was_changed;
  return sample;
}
}  // namespace tapstudy::device
