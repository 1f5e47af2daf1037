#pragma once
#include <optional>

#include "runner/recordings/tap_identification.hpp"
namespace tapstudy::runner {
// The band in which modes are sought: what was asked for, or from 10 Hz to the protocol's band
// limit (1000 Hz without one), where sensors' own filters do not act yet. Throws InvalidInput where
// more is asked for than the rate allows.
analysis::Band sought_band(const TapQuestion& question, double rate_hz,
                           std::optional<double> band_limit_hz);
// The same for a tap's sinusoid, up to 1000 Hz or as far as the rate allows.
analysis::Band band_of_sinusoid(const analysis::Band& sought, double rate_hz);
}  // namespace tapstudy::runner
