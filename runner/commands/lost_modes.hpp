#pragma once
#include "protocols/protocol.hpp"
#include "runner/stimuli/model_library.hpp"
namespace tapstudy::runner {
// Names the modes of each stimulus that a device does not render, whose highest frequency this is.
void print_lost_modes(const protocols::Protocol& protocol, ModelLibrary& models,
                      double vibration_band_hz);
}  // namespace tapstudy::runner
