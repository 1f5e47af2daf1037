#include "device/loop/force_gate.hpp"

#include <algorithm>
namespace tapstudy::device {
using core::TickFault;
namespace {
constexpr double quiet_n = 0.2;
constexpr double quiet_time_needed_s = 0.01;
}  // namespace

ForceGate::ForceGate(const core::GateSettings& settings, double dt_s) noexcept
    : settings_{settings},
      dt_s_{dt_s},
      state_{settings.force_rise_s > 0.0 ? State::armed : State::rendering},
      share_{settings.force_rise_s > 0.0 ? 0.0 : 1.0} {}

bool ForceGate::has_jumped(const core::Vec3& position_m, double elapsed_s) const noexcept {
  return previous_m_ && (position_m - *previous_m_).norm() >
                            2.0 * settings_.max_hand_speed_m_s * std::max(elapsed_s, dt_s_);
}

TickFault ForceGate::fault_of(const core::Vec3& wanted_n, const core::HandState& hand,
                              double elapsed_s) const noexcept {
  if (!wanted_n.allFinite() || !hand.position_m.allFinite() || !hand.velocity_m_s.allFinite()) {
    return TickFault::non_finite_force;
  }
  if (hand.velocity_m_s.norm() > settings_.max_hand_speed_m_s) {
    return TickFault::too_fast;
  }
  if (hand.position_m.norm() > settings_.workspace_radius_m) {
    return TickFault::outside_workspace;
  }
  return has_jumped(hand.position_m, elapsed_s) ? TickFault::too_fast : TickFault::none;
}

void ForceGate::rise_again() noexcept {
  if (state_ == State::rendering && settings_.force_rise_s > 0.0) {
    share_ = 0.0;
    is_rising_again_ = true;
  }
}

void ForceGate::fall_to(double max_share) noexcept {
  if (max_share < share_) {
    share_ = max_share;
    is_rising_again_ = state_ == State::rendering && settings_.force_rise_s > 0.0;
  }
}

void ForceGate::stop() noexcept {
  if (state_ != State::at_rest) {
    state_ = State::stopping;
  }
}

void ForceGate::advance(double wanted_size_n) noexcept {
  if (state_ == State::armed) {
    quiet_s_ = wanted_size_n < quiet_n ? quiet_s_ + dt_s_ : 0.0;
    state_ = quiet_s_ > quiet_time_needed_s - 0.5 * dt_s_ ? State::rendering : State::armed;
  } else if (state_ == State::rendering && share_ < 1.0) {
    share_ = std::min(1.0, share_ + dt_s_ / settings_.force_rise_s);
    is_rising_again_ = is_rising_again_ && share_ < 1.0;
  } else if (state_ == State::stopping) {
    share_ = settings_.force_fall_s > 0.0 ? share_ - dt_s_ / settings_.force_fall_s : 0.0;
    share_ = std::max(share_, 0.0);
    // the rate limit may be slower than the ramp
    if (share_ == 0.0 && previous_n_.isZero(0.0)) {
      state_ = State::at_rest;
    }
  }
}

PassedForce ForceGate::pass(const core::Vec3& wanted_n, const core::HandState& hand,
                            double elapsed_s, double max_share) noexcept {
  const TickFault fault = fault_of(wanted_n, hand, elapsed_s);
  previous_m_ = hand.position_m;
  if (fault != TickFault::none) {
    previous_n_ = core::Vec3::Zero();
    return {core::Vec3::Zero(), true, fault};
  }
  advance(wanted_n.norm());
  fall_to(max_share);
  const core::LimitedForce limited =
      core::limit_force(share_ * wanted_n, previous_n_, settings_.limits, dt_s_);
  previous_n_ = limited.force_n;
  return {limited.force_n, limited.was_changed, TickFault::none};
}
}  // namespace tapstudy::device
