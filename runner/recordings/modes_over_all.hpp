#pragma once
#include <string>
#include <vector>

#include "runner/recordings/tap_identification.hpp"
namespace tapstudy::runner {
// Modes over all taps and channels, ascending frequency. Steady tones that only some taps show are
// fitted in the others, too, and close modes are told apart by all taps together: the taps' modes
// change accordingly. Adds a remark for each tap that is too short for it.
std::vector<analysis::RepeatedMode> modes_over_all(const analysis::Band& band,
                                                   std::vector<IdentifiedTap>& taps,
                                                   std::vector<std::string>& remarks);
}  // namespace tapstudy::runner
