#pragma once
#include <string>
#include <vector>

#include "core/haptic_state.hpp"
#include "protocols/axes/presented_stimulus.hpp"
#include "protocols/rig.hpp"
#include "protocols/tap_script.hpp"
#include "runner/stimuli/model_library.hpp"
namespace tapstudy::runner {
// One tap by the simulated hand with exactly this impact speed, and its trace.
struct ScriptedTap {
  protocols::PresentedStimulus stimulus;
  Eigen::Vector2d at_m{Eigen::Vector2d::Zero()};  // plate frame
  double speed_m_s{0.3};
  double seconds{0.5};
};
// Throws InvalidInput if the point is off the plate or the speed out of 0.001 to 10 m/s.
std::vector<core::TraceSample> trace_of(const ScriptedTap& tap, const protocols::Protocol& protocol,
                                        const protocols::Rig& rig, ModelLibrary& models);

// The simulated hand does what a script says, and its trace. Throws InvalidInput, with the step's
// line, if the finger leaves the plate or cannot be where it should in time.
std::vector<core::TraceSample> trace_of(const protocols::PresentedStimulus& stimulus,
                                        const protocols::TapScript& script,
                                        const protocols::Protocol& protocol,
                                        const protocols::Rig& rig, ModelLibrary& models);

// "X,Y" in metres or the name of a tapping point. Throws InvalidInput if it is neither.
Eigen::Vector2d point_on_plate(const std::string& text, const protocols::Plate& plate);
}  // namespace tapstudy::runner
