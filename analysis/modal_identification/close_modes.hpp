#pragma once
#include <vector>

#include "analysis/modal_identification/repeated_modes.hpp"
namespace tapstudy::analysis {
struct ModesOfTaps {
  std::vector<TapModes> taps;
  std::vector<RepeatedMode> modes;  // ascending frequency
};

// Modes within a half-power bandwidth of one another, which a tap alone may show as one, told apart
// by all taps together: where the matrix pencil of all decays finds at least two poles there, they
// are fitted to all decays at once. They stand if Schwarz's criterion (1978) prefers them to poles
// of each impact's own, so that a plate whose frequency depends on the tap is not taken for two
// modes. Estimates are of the jackknife over impacts (pseudo-values, Tukey 1958), their intervals
// not narrower than what the noise alone gives. Decays and impacts belong to the taps; decays of
// different rates are left as they are.
ModesOfTaps tell_close_modes_apart(const std::vector<FreeDecay>& decays,
                                   const std::vector<int>& impacts, const Band& band,
                                   const ModesOfTaps& found);
}  // namespace tapstudy::analysis
