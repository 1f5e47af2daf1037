#pragma once
#include <optional>

#include "core/settings/render_settings.hpp"
#include "runner/recordings/tap_identification.hpp"
namespace tapstudy::runner {
// Taps of which a decaying sinusoid explains less of the energy are left out.
inline constexpr double min_explained_by_sinusoid = 0.5;

// One law of all taps (Okamura et al. 1998): decay, frequency, and where speeds are known the
// amplitude of one sensor by speed; finger: that makes forces of it, of a protocol. nullopt if no
// tap is left.
std::optional<SinusoidLaw> sinusoid_law(const TapIdentification& found,
                                        const std::optional<core::Finger>& finger);
}  // namespace tapstudy::runner
