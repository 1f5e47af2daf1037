#pragma once
#include <vector>

#include "analysis/modal_identification/repeated_modes.hpp"
namespace tapstudy::analysis {
struct ModesOfTaps {
  std::vector<TapModes> taps;
  std::vector<RepeatedMode> modes;  // ascending frequency
};

// Modes whose half-power bandwidths are wider than the gap between them, which a tap alone may show
// as one, told apart by all taps together: where the matrix pencil of all decays finds at least two
// poles there, they are fitted to all decays at once. They stand if Schwarz's criterion (1978)
// prefers them to poles of each impact's own, so that a plate whose frequency depends on the tap is
// not taken for two modes, if they are found without any of the impacts as well, and if they are
// not one mode whose frequency depends on its amplitude. Intervals are by the jackknife over
// impacts, and not narrower than what the noise alone gives. Decays and impacts belong to the taps.
// Of decays of different rates the most that have one take part in the pencil, all in the fit.
ModesOfTaps tell_close_modes_apart(const std::vector<FreeDecay>& decays,
                                   const std::vector<int>& impacts, const Band& band,
                                   const ModesOfTaps& found);
}  // namespace tapstudy::analysis
