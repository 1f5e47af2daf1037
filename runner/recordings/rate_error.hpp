#pragma once
#include "runner/recordings/tap_identification.hpp"
namespace tapstudy::runner {
// Widens the intervals by what a rate that is wrong by up to this share makes of them: frequencies
// and decays are in proportion to the rate, moduli and stiffnesses to its square, beta to its
// inverse; damping ratios do not depend on it.
void include_rate_error(double share, TapIdentification& identified);
}  // namespace tapstudy::runner
