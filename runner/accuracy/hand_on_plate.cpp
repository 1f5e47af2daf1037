#include "runner/accuracy/hand_on_plate.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/placement.hpp"
namespace tapstudy::runner {
namespace {
constexpr double lasts_s = 2.0;
constexpr double last_part_s = 0.1;
constexpr double approach_s = 0.05;
constexpr double min_speed_m_s = 1e-6;
constexpr double pressing_s = 0.5;
constexpr double highest_m = 0.01;

device::PlannedTap planned(const TestTap& tap, const core::Placement& placement) {
  device::PlannedTap plan;
  plan.point_m = placement.point_to_device(tap.at_m);
  plan.speed_m_s = std::max(tap.speed_m_s, min_speed_m_s);
  plan.hover_m = std::min(highest_m, approach_s * plan.speed_m_s);
  plan.run_up_m = 0.0;
  plan.press_m = std::min(tap.press_m, pressing_s * plan.speed_m_s);
  plan.dwell_s = lasts_s;
  return plan;
}

class Swing {
 public:
  void add(double value) {
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
  }
  double size() const { return std::max(0.0, high_ - low_); }

 private:
  double low_{HUGE_VAL};
  double high_{-HUGE_VAL};
};

// Amplitude of the force oscillation at the end, relative to the whole duration.
class Parts {
 public:
  void add(double value, bool is_at_the_end) {
    whole_.add(value);
    if (is_at_the_end) {
      end_.add(value);
    }
  }
  double left() const { return whole_.size() > 0.0 ? end_.size() / whole_.size() : 0.0; }

 private:
  Swing whole_;
  Swing end_;
};
}  // namespace

LoopBehaviour tap_and_stay(core::TapRenderer& renderer, const core::HandBody& body, double dt_s,
                           const TestTap& tap) {
  const core::Placement placement;
  device::SimulatedHand hand{body, dt_s, device::SimulatedHand::Memory::none};
  hand.follow({planned(tap, placement)});
  LoopBehaviour behaviour;
  Parts penalty;
  Parts vibration;
  const auto ticks = static_cast<int>(std::lround(lasts_s / dt_s));
  const auto last_part = static_cast<int>(std::lround((lasts_s - last_part_s) / dt_s));
  double energy_j = 0.0;
  for (int tick = 0; tick < ticks && behaviour.is_finite; ++tick) {
    core::HandState state;
    static_cast<void>(hand.read(state, dt_s));
    core::HandState tip = placement.to_plate(state);
    tip.position_m.x() += tap.sliding_m * tick / ticks;
    const core::RenderedTick rendered = renderer.tick(tip);
    static_cast<void>(hand.write(core::Placement::force_to_device(rendered.force_n)));
    const double before_j = std::exchange(energy_j, renderer.energy_j());
    behaviour.is_finite = rendered.force_n.allFinite() && std::isfinite(energy_j);
    if (rendered.contact.impact) {
      ++behaviour.impacts;
    } else {
      behaviour.max_gain_j = std::max(behaviour.max_gain_j, energy_j - before_j);
    }
    behaviour.max_energy_j = std::max(behaviour.max_energy_j, energy_j);
    behaviour.max_force_n = std::max(behaviour.max_force_n, std::abs(rendered.parts.total_n()));
    penalty.add(rendered.parts.penalty_n, tick >= last_part);
    vibration.add(rendered.parts.vibration_n, tick >= last_part);
  }
  behaviour.residual_oscillation = std::max(penalty.left(), vibration.left());
  return behaviour;
}
}  // namespace tapstudy::runner
