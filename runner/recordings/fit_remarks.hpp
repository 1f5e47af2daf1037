#pragma once
#include <string>
#include <vector>

#include "runner/recordings/tap_identification.hpp"
namespace tapstudy::runner {
// Taps that are no free decays of the modes found: these explain less than 99.8 % of the energy,
// and what is left exceeds the recording's noise more than four times.
std::vector<std::string> remarks_on_residuals(const std::vector<IdentifiedTap>& taps);
// Agreed modes whose frequency scatters more over the taps than their noise explains.
std::vector<std::string> remarks_on_scatter(const std::vector<analysis::RepeatedMode>& modes);
// Recordings, each once, whose samples have few different values: the end of a decay is lost in a
// step of the converter, which no noise makes good.
std::vector<std::string> remarks_on_resolution(const std::vector<IdentifiedTap>& taps);
// Modes that were matched to the model's by frequency but have another shape.
std::vector<std::string> remarks_on_shapes(const analysis::ModelUpdate& update,
                                           const TapIdentification& identified);
}  // namespace tapstudy::runner
