#include "runner/rig.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
namespace tapstudy::runner {
device::LoopSettings loop_settings(const protocols::Protocol& protocol, const protocols::Rig& rig) {
  device::LoopSettings settings;
  settings.period = std::llround(1e9 / protocol.rate_hz);
  settings.limits = rig.limits;
  settings.placement = rig.placement.value_or(protocol.placement);
  for (const auto& [name, plate] : protocol.plates) {
    if (settings.placement.lateral_scale != 1.0 &&
        std::holds_alternative<core::Solid>(plate.shape)) {
      throw core::InvalidInput{
          fmt::format("rig: placement.lateral_scale: {} is not allowed with plate '{}' (1: only a "
                      "flat plate can "
                      "be scaled sideways)",
                      settings.placement.lateral_scale, name)};
    }
  }
  return settings;
}

device::HandBody hand_body(const protocols::SimulatedHandSettings& hand) {
  return {hand.mass_kg, hand.muscle_stiffness_n_per_m, hand.muscle_damping_n_s_per_m};
}
}  // namespace tapstudy::runner
