#pragma once
#include <limits>

#include "core/tick/force_limiter.hpp"
namespace tapstudy::core {
// Limits applied to every force before it reaches a device.
struct GateSettings {
  ForceLimits limits;
  double max_hand_speed_m_s{std::numeric_limits<double>::infinity()};
  double workspace_radius_m{std::numeric_limits<double>::infinity()};  // from the device's origin
  double force_rise_s{0.0};  // from zero to full force when rendering starts; 0: at once
  double force_fall_s{0.0};  // from full to zero force at a soft stop
};
}  // namespace tapstudy::core
