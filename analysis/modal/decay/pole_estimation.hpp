#pragma once
#include "analysis/modal/decay/free_decay.hpp"
namespace tapstudy::analysis {
inline constexpr int max_model_order = 60;

// The poles found with one model order (an even number of exponentials, two a mode).
struct PolesOfOrder {
  int order{};
  std::vector<Pole> poles;  // inside the band, ascending frequency, damping ratio below 0.7
};

struct MatrixPencil {
  Eigen::VectorXd singular_values;   // of the Hankel matrix, descending
  int significant_order{};           // how many exceed what noise alone gives
  std::vector<PolesOfOrder> orders;  // 2, 4 ... 20 beyond significant_order, max_order at most
};

// The matrix pencil method (Hua & Sarkar 1990): the right singular vectors of the Hankel matrix
// that belong to the `order` largest singular values span shifted exponentials, V2 = V1 Phi, and
// the eigenvalues of Phi are the poles z. The singular vectors are found from the Gram matrix,
// whose entries follow from one another in O(L^2): half of the digits are enough for what was
// measured. Pencil parameter L a third of the samples, at most 400. The decay is decimated first.
// Throws InvalidInput if fewer than 24 samples are left then.
MatrixPencil matrix_pencil(const FreeDecay& decay, const Band& band, int max_order);

// The same for several decays of one structure at one rate, with the standard deviations of their
// noise (above 0): their Gram matrices are added, each divided by the variance of its noise. Modes
// that are too close to be resolved in one decay are resolved in several that excite them in
// different proportions (as with several references, Vold et al. 1982). The pencil parameter
// follows from the median length; decays shorter than twice that are left out. Empty if it is too
// small.
MatrixPencil matrix_pencil(const std::vector<FreeDecay>& decays, const std::vector<double>& noise,
                           const Band& band, int max_order);

// A pole that does not move as the order grows.
struct StablePole {
  Pole pole;     // medians over the orders
  int orders{};  // how many successive orders found it
};
inline constexpr int min_stable_orders = 4;
// Whether the pole of one order is that of the next: within 1 % of its frequency (a sixth of its
// half-power bandwidth if that is more) and 10 % (or 0.003) of its damping ratio.
bool continues(const Pole& from, const Pole& to);
// A stabilisation diagram, read: poles that at least min_stable_orders successive orders found,
// each continuing the one before. The longest chain at a pole counts.
std::vector<StablePole> stable_poles(const std::vector<PolesOfOrder>& orders);

// Poles of a rational fit to a spectrum by vector fitting (Gustavsen & Semlyen 1999), in z: the
// transform of a free decay, cut off anywhere, is sum r / (z - p) + d at the bins exactly, for
// z^N = 1 there; 1 / (1 - 1 / z) takes up a drift. `pairs` pairs of poles start spread over the
// band and are relocated, unstable ones mirrored into the unit circle, until they settle. Knows
// nothing of matrix_pencil. Poles inside the band, ascending frequency; with more pairs than modes
// the rest settles on noise. Throws InvalidInput for more unknowns than values.
std::vector<Pole> vector_fitting(const BandSpectrum& spectrum, int pairs);
}  // namespace tapstudy::analysis
