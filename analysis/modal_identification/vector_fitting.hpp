#pragma once
#include "analysis/modal_identification/free_decay.hpp"
namespace tapstudy::analysis {
// Poles of a rational fit to a spectrum by vector fitting (Gustavsen & Semlyen 1999), in z: the
// transform of a free decay, cut off anywhere, is sum r / (z - p) + d at the bins exactly, for
// z^N = 1 there; 1 / (1 - 1 / z) takes up a drift. `pairs` pairs of poles start spread over the
// band and are relocated, unstable ones mirrored into the unit circle, until they settle. Knows
// nothing of matrix_pencil. Poles inside the band, ascending frequency; with more pairs than modes
// the rest settles on noise. Throws InvalidInput for more unknowns than values.
std::vector<Pole> vector_fitting(const BandSpectrum& spectrum, int pairs);
}  // namespace tapstudy::analysis
