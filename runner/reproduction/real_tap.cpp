#include "runner/reproduction/real_tap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "runner/devices/rigs.hpp"
#include "runner/experiments/scripted_tap.hpp"
namespace tapstudy::runner {
namespace {
constexpr double tapped_s = 0.4;  // long enough for the 0.16 s that feeling takes, after a bounce

const core::Technique& coupled_finger() {
  const std::vector<const core::ForcePart*> alone{&core::coupled_vibration};
  return *std::ranges::find(core::techniques(), alone, &core::Technique::parts);
}
}  // namespace

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
    power += std::pow(10.0, level / 10.0) - 1.0;
  }
  return 10.0 * std::log10(1.0 + power);
}
}  // namespace tapstudy::runner
