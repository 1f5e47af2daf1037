#pragma once
#include "protocols/protocol.hpp"
#include "runner/stimuli/model_library.hpp"
namespace tapstudy::runner {
// The energy that a strike leaves in a plate at rest, over the kinetic energy of the finger, whose
// momentum goes to the modes (paper eq. 14 to 16): m sum over modes of (phi . n)^2. Above 1 the
// finger gives more than it has. at_m: on the plate from above, plate frame.
double impact_energy_share(const core::VibratingPlate& plate, const Eigen::Vector2d& at_m,
                           double finger_kg);
// Prints a warning for each stimulus with a tapping point where it is above 1, and one for each
// that can move as a rigid body, which no technique renders.
void warn_of_light_plates(const protocols::Protocol& protocol, ModelLibrary& models);
}  // namespace tapstudy::runner
