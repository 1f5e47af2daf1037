#include "device/force_gate.hpp"

#include <algorithm>
namespace tapstudy::device {
using core::TickFault;
namespace {
constexpr double quiet_n = 0.2;
constexpr int quiet_ticks_needed = 10;
}  // namespace

ForceGate::ForceGate(const GateSettings& settings, double dt_s) noexcept
    : settings_{settings},
      dt_s_{dt_s},
      state_{settings.rise_s > 0.0 ? State::armed : State::rendering},
      share_{settings.rise_s > 0.0 ? 0.0 : 1.0} {}

TickFault ForceGate::fault_of(const core::Vec3& wanted_n,
                              const core::HandState& hand) const noexcept {
  if (!wanted_n.allFinite() || !hand.position_m.allFinite() || !hand.velocity_m_s.allFinite()) {
    return TickFault::non_finite_force;
  }
  if (hand.velocity_m_s.norm() > settings_.max_speed_m_s) {
    return TickFault::too_fast;
  }
  return hand.position_m.norm() > settings_.workspace_radius_m ? TickFault::outside_workspace
                                                               : TickFault::none;
}

void ForceGate::stop() noexcept {
  if (state_ != State::at_rest) {
    state_ = State::stopping;
  }
}

void ForceGate::advance(double wanted_size_n) noexcept {
  if (state_ == State::armed) {
    quiet_ticks_ = wanted_size_n < quiet_n ? quiet_ticks_ + 1 : 0;
    state_ = quiet_ticks_ >= quiet_ticks_needed ? State::rendering : State::armed;
  } else if (state_ == State::rendering && share_ < 1.0) {
    share_ = std::min(1.0, share_ + dt_s_ / settings_.rise_s);
  } else if (state_ == State::stopping) {
    share_ = settings_.fall_s > 0.0 ? share_ - dt_s_ / settings_.fall_s : 0.0;
    if (share_ <= 0.0) {
      share_ = 0.0;
      state_ = State::at_rest;
    }
  }
}

PassedForce ForceGate::pass(const core::Vec3& wanted_n, const core::HandState& hand) noexcept {
  const TickFault fault = fault_of(wanted_n, hand);
  if (fault != TickFault::none) {
    previous_n_ = core::Vec3::Zero();
    return {core::Vec3::Zero(), true, fault};
  }
  advance(wanted_n.norm());
  const core::LimitedForce limited =
      core::limit_force(share_ * wanted_n, previous_n_, settings_.limits, dt_s_);
  previous_n_ = limited.force_n;
  return {limited.force_n, limited.was_changed || share_ < 1.0, TickFault::none};
}
}  // namespace tapstudy::device
