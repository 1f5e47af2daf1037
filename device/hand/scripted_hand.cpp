#include "device/hand/scripted_hand.hpp"

#include <algorithm>
#include <cmath>
namespace tapstudy::device {
namespace {
// The hand follows its aim with a transient of time constant 2 m/d. After 4.5 of them at constant
// speed 1 % of it is left; a hand that is hardly damped is not waited for.
double settling_s(const core::HandBody& body) {
  constexpr double longest_s = 0.2;
  return std::min(longest_s, 4.5 * 2.0 * body.mass_kg / body.muscle_damping_n_s_per_m);
}

PlannedTap planned(const RepeatedTap& tap, const core::Placement& placement) {
  PlannedTap planned;
  planned.point_m = placement.point_to_device(tap.place_m);
  planned.speed_m_s = tap.speed_m_s;
  planned.hover_m = planned.run_up_m + tap.speed_m_s * settling_s(tap.body);
  planned.dwell_s = tap.dwell_s;
  planned.pause_s = tap.pause_s;
  return planned;
}
}  // namespace

double RepeatedTap::duration_s() const {
  return TapPath{{planned(*this, {})}}.duration_s();
}

ScriptedHand::ScriptedHand(const RepeatedTap& tap, const core::Placement& placement, double dt_s)
    : body_{tap.body, dt_s},
      dt_s_{dt_s},
      path_{{planned(tap, placement)}},
      period_ticks_{static_cast<std::int64_t>(std::ceil(path_.duration_s() / dt_s))} {
  restart();
}

core::Vec3 ScriptedHand::aim_m(std::int64_t tick) const noexcept {
  return path_.at(static_cast<double>(tick) * dt_s_).position_m;
}

void ScriptedHand::move(const core::Vec3& force_n) noexcept {
  body_.move(aim_m(tick_), aim_m(tick_ + 1), force_n);
  if (++tick_ == period_ticks_) {
    restart();
  }
}

void ScriptedHand::restart() noexcept {
  tick_ = 0;
  body_.place({aim_m(0), core::Vec3::Zero()});
}
}  // namespace tapstudy::device
