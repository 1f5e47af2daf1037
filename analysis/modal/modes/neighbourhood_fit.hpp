#pragma once
#include <vector>

#include "analysis/modal/modes/close_modes.hpp"
namespace tapstudy::analysis {
// Agreed modes of one impact by the part of the spectrum around them alone. What the model of the
// whole band does not describe, such as a mode far off that is not linear, is smooth there, so that
// the nuisance terms take it up (decay_model.hpp); in the fit of the whole band it falsifies the
// others' damping, far beyond what the noise explains. Over several impacts that cannot be missed;
// of one nothing else shows it. The estimates are replaced where their standard errors are less
// than half as large, or where they contradict those of the whole band by more than three; a
// standard error holds what half of the part says otherwise. Decays belong to the taps.
void fit_neighbourhoods(const std::vector<FreeDecay>& decays, const Band& band,
                        const std::vector<TapModes>& taps, std::vector<RepeatedMode>& modes);
}  // namespace tapstudy::analysis
