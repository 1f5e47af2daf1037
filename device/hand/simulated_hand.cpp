#include "device/hand/simulated_hand.hpp"

#include <cmath>
namespace tapstudy::device {
core::StateTransition muscle_transition(const core::HandBody& body, double dt_s) noexcept {
  const double omega = std::sqrt(body.muscle_stiffness_n_per_m / body.mass_kg);
  const double ratio = body.muscle_damping_n_s_per_m / (2.0 * body.mass_kg * omega);
  return core::exact_transition(omega, ratio, dt_s);
}

SimulatedHand::SimulatedHand(const core::HandBody& body, double dt_s, Memory memory)
    : body_{body}, dt_s_{dt_s}, memory_{memory}, step_{muscle_transition(body, dt_s)} {}

double SimulatedHand::follow(std::vector<PlannedTap> taps) {
  path_ = TapPath{std::move(taps), has_started_ ? std::optional{hand_.position_m} : std::nullopt};
  ticks_ = 0;
  if (!has_started_) {
    const Target start = path_.at(0.0);
    hand_ = {start.position_m, start.velocity_m_s};
    has_started_ = true;
  }
  if (memory_ == Memory::kept) {
    felt_.reserve(felt_.size() + static_cast<std::size_t>(std::ceil(path_.duration_s() / dt_s_)));
  }
  return path_.duration_s();
}

core::TickFault SimulatedHand::read(core::HandState& hand, double /*elapsed_s*/) noexcept {
  hand = hand_;
  return core::TickFault::none;
}

core::TickFault SimulatedHand::write(const core::Vec3& force_n) noexcept {
  force_n_ = force_n;
  if (memory_ == Memory::kept && felt_.size() < felt_.capacity()) {
    felt_.push_back({hand_, force_n});
  }
  // In coordinates moving with the aim, a constant force shifts the equilibrium position.
  const Target now = path_.at(static_cast<double>(ticks_) * dt_s_);
  const Target next = path_.at(static_cast<double>(++ticks_) * dt_s_);
  const core::Vec3 drift_m_s = (next.position_m - now.position_m) / dt_s_;
  const core::Vec3 rest_m = force_n / body_.muscle_stiffness_n_per_m;
  const core::Vec3 offset_m = hand_.position_m - now.position_m - rest_m;
  const core::Vec3 relative_m_s = hand_.velocity_m_s - drift_m_s;
  hand_.position_m = next.position_m + rest_m + step_.qq * offset_m + step_.qv * relative_m_s;
  hand_.velocity_m_s = drift_m_s + step_.vq * offset_m + step_.vv * relative_m_s;
  return core::TickFault::none;
}
}  // namespace tapstudy::device
