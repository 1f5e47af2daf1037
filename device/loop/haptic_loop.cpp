#include "device/loop/haptic_loop.hpp"

#include <algorithm>
#include <limits>
#include <utility>
namespace tapstudy::device {
using core::TickFault;
namespace {
std::array<double, 3> as_array(const core::Vec3& v) noexcept {
  return {v.x(), v.y(), v.z()};
}
// Longer than the two clocks can be read apart, shorter than any sleep.
constexpr Nanoseconds min_suspension = 10'000'000;
// After a longer time without a tick, force rises again from nothing.
constexpr Nanoseconds max_gap = 3'000'000;
// No vibration outlasts so many periods.
constexpr Nanoseconds max_made_up = 100'000;

core::Vec3 as_vector(const std::array<double, 3>& a) noexcept {
  return {a[0], a[1], a[2]};
}
}  // namespace

HapticLoop::HapticLoop(Device& device, std::span<core::TapRenderer> alternatives,
                       LoopSettings settings, core::SpscRing<core::TraceSample>& trace,
                       TickClock& clock, ScriptedHand* taps) noexcept
    : device_{device},
      alternatives_{alternatives},
      settings_{std::move(settings)},
      trace_{trace},
      clock_{clock},
      taps_{taps},
      gate_{settings_.gate, 1e-9 * static_cast<double>(settings_.period)} {}

void HapticLoop::run(const std::stop_token& stop) noexcept {
  while (!stop.stop_requested() && step()) {
  }
  gate_.stop();
  while (gate_.state() != ForceGate::State::at_rest && step()) {
  }
  zero_force();
}

void HapticLoop::run_ticks(std::int64_t count) noexcept {
  while (count-- > 0 && step()) {
  }
}

void HapticLoop::zero_force() noexcept {
  tell_actuator_of_end();
  if (report_.stopped_by == TickFault::none) {
    report_.stop = device_.zero_force();
    if (report_.stop == StopOutcome::unconfirmed) {
      report_.stopped_by = TickFault::stop_unconfirmed;
    }
  }
}

bool HapticLoop::step() noexcept {
  if (report_.stopped_by != TickFault::none) {
    return false;
  }
  if (!has_begun_) {
    begin();
  }
  const Nanoseconds woke_at = clock_.wait_until(deadline_);
  note_lateness(woke_at);
  const Nanoseconds elapsed = woke_at - std::exchange(last_tick_, woke_at);
  core::TraceSample sample = unread_sample(woke_at - began_at());
  sample.fault = fault_of_time(woke_at, elapsed);
  if (sample.fault == TickFault::none) {
    ticked_at_.store(woke_at, std::memory_order_release);
    sample = tick(woke_at - began_at(), elapsed);
  }
  if (sample.fault != TickFault::none) {
    report_.stop = device_.emergency_stop();
  }
  trace_.try_push(sample);
  ++report_.ticks;
  report_.saturated += sample.saturated ? 1 : 0;
  report_.stopped_by = sample.fault;
  return sample.fault == TickFault::none;
}

// Time starts here, so that the thread's set-up does not count as lateness.
void HapticLoop::begin() noexcept {
  fault_at_begin_ = device_.begin();
  suspended_before_ = clock_.suspended();
  deadline_ = last_beat_ = last_tick_ = clock_.now();
  start_.store(deadline_, std::memory_order_release);
  has_begun_ = true;
}

// A missed period is skipped, never made up for in a burst of ticks; the phase is kept.
void HapticLoop::note_lateness(Nanoseconds woke_at) noexcept {
  const Nanoseconds lateness = woke_at - deadline_;
  missed_ = lateness / settings_.period;
  const bool is_late = lateness > settings_.period / 2;
  report_.lateness.add(lateness);
  report_.late += is_late ? 1 : 0;
  late_in_a_row_ = is_late ? late_in_a_row_ + 1 : 0;
  report_.skipped += missed_;
  missed_lately_.add(woke_at - began_at(), missed_);
  deadline_ += (missed_ + 1) * settings_.period;
}

TickFault HapticLoop::fault_of_absence(Nanoseconds elapsed) noexcept {
  if (clock_.suspended() - suspended_before_ > min_suspension) {
    return TickFault::suspended;
  }
  return settings_.max_stall > 0 && elapsed > settings_.max_stall ? TickFault::loop_stalled
                                                                  : TickFault::none;
}

TickFault HapticLoop::fault_of_time(Nanoseconds woke_at, Nanoseconds elapsed) noexcept {
  if (fault_at_begin_ != TickFault::none) {
    return fault_at_begin_;
  }
  if (const TickFault fault = fault_of_absence(elapsed); fault != TickFault::none) {
    return fault;
  }
  if (has_beaten_.exchange(false, std::memory_order_acq_rel)) {
    last_beat_ = woke_at;
  }
  // no heartbeat is required while the force ramps down
  const bool is_looked_after =
      settings_.max_heartbeat_gap > 0 && gate_.state() != ForceGate::State::stopping;
  if (is_looked_after && (woke_at - last_beat_ > settings_.max_heartbeat_gap ||
                          elapsed > settings_.max_heartbeat_gap)) {
    return TickFault::heartbeat_lost;  // or the loop itself stalled for as long
  }
  const TickFault fault = fault_of_lateness();
  return fault == TickFault::none ? fault_of_actuator() : fault;
}

TickFault HapticLoop::fault_of_actuator() const noexcept {
  return actuator_.fault == nullptr ? TickFault::none
                                    : actuator_.fault->load(std::memory_order_acquire);
}

TickFault HapticLoop::fault_of_lateness() const noexcept {
  if (settings_.max_late_in_a_row > 0 && late_in_a_row_ > settings_.max_late_in_a_row) {
    return TickFault::too_late;
  }
  const auto missed = static_cast<double>(missed_lately_.within_a_second() * settings_.period);
  return missed > settings_.max_missed_share * 1e9 ? TickFault::periods_missed : TickFault::none;
}

void HapticLoop::take_requests() noexcept {
  // first the silence: an interval that opens must not have the alternative of the one before
  const bool is_silence_wanted = silence_requested_.load(std::memory_order_acquire);
  const std::size_t wanted = requested_.load(std::memory_order_acquire);
  const bool is_change = wanted != current_ || is_silence_wanted != is_silent_;
  if (is_change && !alternatives_[current_].is_touching()) {
    alternatives_[wanted].take_over_from(alternatives_[current_]);
    current_ = wanted;
    is_silent_ = is_silence_wanted;
    rendering_.store(is_silent_ ? nothing : current_, std::memory_order_release);
    if (taps_ != nullptr) {
      taps_->restart();
    }
  }
}

// A tick without a reading has no position: NaN, since zero would be a valid one.
core::TraceSample HapticLoop::unread_sample(Nanoseconds now) const noexcept {
  core::TraceSample sample{};
  sample.t_ns = now;
  sample.alternative = static_cast<std::uint8_t>(current_);
  sample.late = late_in_a_row_ > 0;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  sample.position_m.fill(unknown);
  sample.velocity_m_s.fill(unknown);
  sample.pose_residual_m = unknown;
  sample.closure_margin = unknown;
  sample.achieved_n.fill(unknown);
  sample.motor_voltage_v = unknown;
  return sample;
}

core::TraceSample HapticLoop::tick(Nanoseconds now, Nanoseconds elapsed) noexcept {
  take_requests();
  core::TraceSample sample = unread_sample(now);
  core::HandState hand{as_vector(sample.position_m), as_vector(sample.velocity_m_s)};
  const double elapsed_s = 1e-9 * static_cast<double>(elapsed);
  sample.fault = device_.read(hand, elapsed_s);
  sample.position_m = as_array(hand.position_m);
  sample.velocity_m_s = as_array(hand.velocity_m_s);
  const DeviceDetail detail = device_.detail();
  sample.pose_residual_m = detail.pose_residual_m;
  sample.closure_margin = detail.closure_margin;
  sample.motor_voltage_v = detail.motor_voltage_v;
  sample.missed_replies = static_cast<std::uint8_t>(detail.missed_replies);
  if (sample.fault == TickFault::none) {
    unread_s_ += elapsed_s;
    const double share = bridging_share(detail, elapsed);
    render(hand, share, unread_s_, sample);
    unread_s_ = detail.missed_replies > 0 ? unread_s_ : 0.0;
  }
  return sample;
}

// Force fades while replies are missing, and rises again from there. After any other gap it rises
// again from nothing.
double HapticLoop::bridging_share(const DeviceDetail& detail, Nanoseconds elapsed) noexcept {
  const bool is_bridged = detail.missed_replies > 0;
  if (elapsed > std::max(max_gap, 2 * settings_.period) && !is_bridged && !was_bridged_) {
    gate_.rise_again();
  }
  report_.bridged += is_bridged ? 1 : 0;
  was_bridged_ = is_bridged;
  return std::max(0.0, 1.0 - detail.unanswered_s / max_unanswered_s);
}

core::RenderedTick HapticLoop::follow(const core::HandState& hand,
                                      core::TraceSample& sample) noexcept {
  const int periods = 1 + static_cast<int>(std::min(missed_, max_made_up));
  return taps_ != nullptr
             ? follow_taps(periods, sample)
             : alternatives_[current_].tick(settings_.placement.to_plate(hand), periods);
}

// In silence the scripted hand rests above its place, so that each interval begins alike.
core::RenderedTick HapticLoop::follow_taps(int periods, core::TraceSample& sample) noexcept {
  for (int missed = 1; missed < periods && !is_silent_; ++missed) {
    taps_->move(on_taps_n_);
  }
  const core::HandState tip = taps_->state();
  const core::RenderedTick followed =
      alternatives_[current_].tick(settings_.placement.to_plate(tip), periods);
  on_taps_n_ = core::Placement::force_to_device(followed.force_n);
  if (!is_silent_) {
    taps_->move(on_taps_n_);
  }
  sample.position_m = as_array(tip.position_m);
  sample.velocity_m_s = as_array(tip.velocity_m_s);
  return followed;
}

void HapticLoop::render(const core::HandState& hand, double share, double elapsed_s,
                        core::TraceSample& sample) noexcept {
  // in silence the contact is followed all the same: force must not begin inside the plate
  const core::RenderedTick followed = follow(hand, sample);
  const core::RenderedTick rendered = is_silent_ ? core::RenderedTick{} : followed;
  const PassedForce passed =
      gate_.pass(core::Placement::force_to_device(rendered.force_n), hand, elapsed_s, share);
  sample.penetration_m = rendered.contact.penetration_m;
  sample.penalty_n = rendered.parts.penalty_n;
  sample.vibration_n = rendered.parts.vibration_n;
  sample.sinusoid_n = rendered.parts.sinusoid_n;
  sample.touching = rendered.contact.touching;
  sample.impact = rendered.contact.impact;
  if (sample.impact) {  // a bounce on the plate is none
    contacts_.at(current_).fetch_add(1, std::memory_order_release);
  }
  sample.fault = passed.fault;
  if (passed.fault != TickFault::none) {
    return;
  }
  sample.saturated = passed.was_changed;
  sample.late = sample.late || gate_.is_rising_again();
  sample.fault = device_.write(passed.force_n);
  tell_actuator(rendered, passed.force_n);
  sample.force_n = as_array(passed.force_n);
  sample.achieved_n = as_array(device_.detail().achieved_n);
}

// What a full ring loses is stale by then.
void HapticLoop::tell_actuator(const core::RenderedTick& rendered,
                               const core::Vec3& passed_n) noexcept {
  if (actuator_.ticks == nullptr) {
    return;
  }
  core::ActuatorTick tick = core::actuator_tick(rendered.contact);
  tick.at_ns = last_tick_;
  tick.passed_share = core::passed_share(rendered.force_n.norm(), passed_n.norm());
  tick.alternative = static_cast<std::uint8_t>(current_);
  actuator_.ticks->try_push(tick);
}

// After a fault it hears of no more ticks, and is silent at once.
void HapticLoop::tell_actuator_of_end() noexcept {
  if (actuator_.ticks == nullptr || report_.stopped_by != TickFault::none) {
    return;
  }
  core::ActuatorTick end = core::actuator_tick({});
  end.at_ns = last_tick_ + settings_.period;
  end.alternative = static_cast<std::uint8_t>(current_);
  end.is_last = true;
  actuator_.ticks->try_push(end);
}
}  // namespace tapstudy::device
