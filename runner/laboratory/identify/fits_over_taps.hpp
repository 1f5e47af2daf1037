#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/settings/render_settings.hpp"
#include "runner/laboratory/identify/tap_identification.hpp"
#include "runner/laboratory/identify/tap_remarks.hpp"
namespace tapstudy::runner {
// Taps of which a decaying sinusoid explains less of the energy are left out.
inline constexpr double min_explained_by_sinusoid = 0.5;

// One law of all taps (Okamura et al. 1998): decay, frequency, and where speeds are known the
// amplitude of one sensor by speed; finger: that makes forces of it, of a protocol. nullopt where
// why_no_sinusoid says why.
std::optional<SinusoidLaw> sinusoid_law(const TapIdentification& found,
                                        const std::optional<core::Finger>& finger);
// A sentence: no tap is left, or those that are have not one frequency, of which a mean would be
// that of nothing. Empty: there is a law.
std::string why_no_sinusoid(const TapIdentification& found);

// Taps that are no free decays of the modes found: these explain less than 99.8 % of the energy,
// and what is left exceeds the recording's noise more than four times.
void remark_on_residuals(const std::vector<IdentifiedTap>& taps, TapRemarks& remarks);
// Agreed modes whose frequency scatters more over the taps than their noise explains.
std::vector<std::string> remarks_on_scatter(const std::vector<analysis::RepeatedMode>& modes);
// Recordings, each once, whose samples have few different values: the end of a decay is lost in a
// step of the converter, which no noise makes good.
std::vector<std::string> remarks_on_resolution(const std::vector<IdentifiedTap>& taps);
// Modes that were matched to the model's by frequency but have another shape.
std::vector<std::string> remarks_on_shapes(const analysis::ModelUpdate& update,
                                           const ModalFindings& identified);
}  // namespace tapstudy::runner
