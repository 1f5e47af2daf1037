#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/settings/render_settings.hpp"
#include "runner/laboratory/identify/tap_identification.hpp"
namespace tapstudy::runner {
// The band in which modes are sought: what was asked for, or from 10 Hz to the protocol's band
// limit (1000 Hz without one), where sensors' own filters do not act yet. Throws InvalidInput where
// more is asked for than the rate allows.
analysis::Band modal_band(const TapQuestion& question, double rate_hz,
                          std::optional<double> band_limit_hz);
// The same for a tap's sinusoid, up to 1000 Hz or as far as the rate allows.
analysis::Band band_of_sinusoid(const analysis::Band& sought, double rate_hz);

// Modes over all taps and channels, ascending frequency. Steady tones that only some taps show are
// fitted in the others, too, and close modes are told apart by all taps together: the taps' modes
// change accordingly. Adds a remark for each tap that is too short for it.
std::vector<analysis::RepeatedMode> modes_over_all(const analysis::Band& band,
                                                   std::vector<IdentifiedTap>& taps,
                                                   std::vector<std::string>& remarks);

// Taps of which a decaying sinusoid explains less of the energy are left out.
inline constexpr double min_explained_by_sinusoid = 0.5;

// One law of all taps (Okamura et al. 1998): decay, frequency, and where speeds are known the
// amplitude of one sensor by speed; finger: that makes forces of it, of a protocol. nullopt if no
// tap is left.
std::optional<SinusoidLaw> sinusoid_law(const TapIdentification& found,
                                        const std::optional<core::Finger>& finger);

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
