#include "runner/rig.hpp"

#include <cmath>
namespace tapstudy::runner {
device::LoopSettings loop_settings(const protocols::Protocol& protocol, const protocols::Rig& rig) {
  device::LoopSettings settings;
  settings.period = std::llround(1e9 / protocol.rate_hz);
  settings.limits = rig.limits;
  settings.placement = rig.placement.value_or(protocol.placement);
  return settings;
}

device::HandBody hand_body(const protocols::SimulatedHandSettings& hand) {
  return {hand.mass_kg, hand.muscle_stiffness_n_per_m, hand.muscle_damping_n_s_per_m};
}
}  // namespace tapstudy::runner
