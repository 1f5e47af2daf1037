#pragma once
#include <vector>

#include "analysis/modal/modes/repeated_modes.hpp"
namespace tapstudy::analysis {
// Modes whose intervals, frequency plus and minus half-power bandwidth, overlap; a mode alone is a
// group of its own.
struct CloseModes {
  Band range;
  std::size_t agreed{};
  double least_ratio{};
  double greatest_ratio{};

  // Inside the range, damped at most five times less or more than these.
  bool may_hold(const Pole& pole) const;
};

// All modes but lines, in ascending frequency as they are given.
std::vector<CloseModes> close_modes_among(const std::vector<RepeatedMode>& modes);

// Two poles or more, and no fewer than are agreed, as most orders show them (at least as many as
// make a pole stable); empty: none.
std::vector<Pole> poles_of_all_decays(const MatrixPencil& pencil, const CloseModes& neighbours);

// A mode whose frequency depends on its amplitude is, to first order, one pole and another of the
// same frequency and three times its decay (a cubic stiffness, Nayfeh & Mook 1979).
bool may_be_one_nonlinear_mode(const std::vector<Pole>& poles);

struct ModesOfTaps {
  std::vector<TapModes> taps;
  std::vector<RepeatedMode> modes;  // ascending frequency
  std::vector<double> taken_hz{};   // steady tones that were taken out of the decays
};

// Modes whose half-power bandwidths are wider than the gap between them, which a tap alone may show
// as one, told apart by all taps together: where the matrix pencil of all decays finds at least two
// poles there, they are fitted to all decays at once. They stand if Schwarz's criterion (1978)
// prefers them to poles of each impact's own, so that a plate whose frequency depends on the tap is
// not taken for two modes, if they are found without any of the impacts as well, and if they are
// not one mode whose frequency depends on its amplitude. Intervals are by the jackknife over
// impacts, and not narrower than what the noise alone gives. Decays and impacts belong to the taps.
// Where decays differ in rate, the largest group of one rate enters the pencil, and all enter the
// fit.
ModesOfTaps resolve_close_modes(const std::vector<FreeDecay>& decays,
                                const std::vector<int>& impacts, const Band& band,
                                const ModesOfTaps& found);
}  // namespace tapstudy::analysis
