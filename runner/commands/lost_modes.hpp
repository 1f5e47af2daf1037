#pragma once
#include "protocols/protocol.hpp"
#include "protocols/rig.hpp"
#include "runner/stimuli/model_library.hpp"
namespace tapstudy::runner {
// Names the modes of each stimulus that the rig's device does not render: above its vibration band,
// which is 300 Hz where a device of hardware states none (the paper, section 4), and where its
// response to a vibration is below a half. Nothing of a rig that has neither.
void print_lost_modes(const protocols::Protocol& protocol, ModelLibrary& models,
                      const protocols::Rig& rig);
}  // namespace tapstudy::runner
