#include "runner/reproduction/real_tap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/error.hpp"
#include "core/tick/coupled_finger.hpp"
#include "core/tick/modal_state.hpp"
#include "runner/devices/rigs.hpp"
#include "runner/experiments/scripted_tap.hpp"
#include "runner/reproduction/routes.hpp"
namespace tapstudy::runner {
namespace {
constexpr double tapped_s = 0.4;  // long enough for the 0.16 s that feeling takes, after a bounce

const core::Technique& coupled_finger() {
  const std::vector<const core::ForcePart*> alone{&core::coupled_vibration};
  return *std::ranges::find(core::techniques(), alone, &core::Technique::parts);
}
}  // namespace

RealTap real_tap(const core::VibratingPlate* plate, const core::RenderSettings& settings,
                 const Eigen::Vector2d& at_m, double seconds) {
  constexpr double pressed_m = 0.002;
  constexpr double speed_m_s = real_over_virtual_speed * tap_speed_m_s;
  const double dt_s = settings.dt_s;
  std::optional<core::ModalState> state;
  if (plate != nullptr) {
    state.emplace(plate->model, settings.integrator, dt_s);
    state->touch(plate->locator->locate(at_m.x(), at_m.y()), core::Vec3::UnitZ());
  }
  core::CoupledFinger finger{settings.finger, settings.penalty_stiffness_n_per_m, dt_s};
  finger.begin(0.0, -speed_m_s, 0.0);
  const auto ticks = static_cast<Eigen::Index>(std::lround(seconds / dt_s));
  RealTap tap{Eigen::VectorXd{ticks}, Eigen::VectorXd::Zero(ticks), Eigen::VectorXd{ticks}};
  double velocity_m_s = 0.0;
  for (Eigen::Index i = 0; i < ticks; ++i) {
    core::SurfaceTick surface;
    if (state) {
      state->tick();
      surface = {state->previous_displacement_m(), state->displacement_m(),
                 state->compliance_m_per_n()};
    }
    const double hand_m = -std::min(pressed_m, speed_m_s * dt_s * static_cast<double>(i + 1));
    const double contact_n = finger.tick(hand_m, surface);
    tap.force_n[i] = finger.force_on_hand_n();
    tap.finger_m_s2[i] = (contact_n - tap.force_n[i]) / settings.finger.mass_kg;
    if (state) {
      state->push(-contact_n);
      tap.plate_m_s2[i] = (state->velocity_m_s() - velocity_m_s) / dt_s;
      velocity_m_s = state->velocity_m_s();
    }
  }
  return tap;
}

protocols::Protocol with_real_finger(protocols::Protocol protocol) {
  protocol.rate_hz = real_rate_hz;
  protocol.rendering.dt_s = 1.0 / real_rate_hz;
  protocol.rendering.integrator = core::Integrator::exact;
  protocol.rendering.finger.mass_kg = real_finger_kg;
  for (protocols::Stimulus& stimulus : protocol.stimuli) {
    stimulus.technique = &coupled_finger();
  }
  return protocol;
}

protocols::Rig unlimited_rig() {
  constexpr double none = std::numeric_limits<double>::infinity();
  protocols::Rig rig = simulated_rig();
  rig.gate.limits.max_force_n = none;
  rig.gate.limits.max_force_rate_n_per_s = none;
  return rig;
}

std::vector<FeltTap> felt_tap(const protocols::Protocol& protocol, const std::string& stimulus,
                              const std::string& point, double speed_m_s, ModelLibrary& models) {
  const auto presented = stimulus_with(protocol, protocol.stimulus(stimulus));
  const ScriptedTap tap{presented, presented.plate->tapping_points_m.at(point), speed_m_s,
                        tapped_s};
  std::vector<device::FeltTick> felt;
  for (const core::TraceSample& sample : trace_of(tap, protocol, unlimited_rig(), models)) {
    const core::HandState hand{
        core::Vec3{sample.position_m[0], sample.position_m[1], sample.position_m[2]},
        core::Vec3::Zero()};
    felt.push_back({hand, {sample.force_n[0], sample.force_n[1], sample.force_n[2]}});
  }
  std::vector<FeltTap> taps =
      felt_taps(felt, protocol.rendering.dt_s, protocol.simulation.observer.threshold_n);
  if (taps.empty()) {
    throw core::InvalidInput{"no tap stays in contact for the 0.16 s that feeling it takes"};
  }
  return taps;
}

double level_db(const FeltTap& tap) {
  double power = 0.0;
  for (const double level : tap.level_db) {
    power += std::pow(10.0, level / 10.0) - 1.0;  // as features_of adds it
  }
  constexpr double least = 1e-12;
  return 10.0 * std::log10(std::max(power, least));
}
}  // namespace tapstudy::runner
