#pragma once
#include <optional>
#include <string>
#include <vector>

#include "runner/recordings/tap_identification.hpp"
namespace tapstudy::runner {
// One recording: channels that were measured at the same times.
struct MeasuredFile {
  std::vector<analysis::Recording> channels;
  std::optional<analysis::Recording> force;  // [N]
};
// Throws InvalidInput as read_recording does.
MeasuredFile read_measured_file(const std::string& file, const TapQuestion& question);

// Of the channel in which taps stand out most from the noise; they are the same in all channels.
// Throws InvalidInput if no channel has one.
analysis::FoundTaps find_taps(const MeasuredFile& measured, const analysis::TapFinding& finding);

// The integral of the force over an impact, from before its onset to the free decay, above what it
// was before.
double impulse_n_s(const analysis::Recording& force, const analysis::Tap& tap);
}  // namespace tapstudy::runner
