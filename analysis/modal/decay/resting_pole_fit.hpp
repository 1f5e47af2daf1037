#pragma once
#include <vector>

#include "analysis/modal/decay/free_decay.hpp"
namespace tapstudy::analysis {
// A mode whose frequency and damping follow its amplitude. Its motion dies away as a power series
// in that of the mode at rest (Poincaré's normal form of a focus): exp((i w - d) t), exp((i w - 2
// d) t), ... with a pole at rest, s = -d + i w, that all taps share, and complex shares of each tap
// and sensor. A linear mode has one term.
struct RestingPole {
  Pole pole;
  int terms{1};
};

// One decay near some modes.
struct NearbyDecay {
  BandSpectrum spectrum;
  std::vector<double> lines_hz;  // steady tones inside
  int impact{};
};

// One tap's or sensor's view of the first pole.
struct SeenAtTap {
  Pole pole;           // over the first four periods: the mean slope of its logarithm
  double amplitude{};  // there
  double share{};      // of the energy in the spectrum that all its terms explain
};

struct RestingFit {
  std::vector<RestingPole> poles;
  std::vector<SeenAtTap> seen;  // decay by decay
  // -2 ln likelihood with a variance of each decay, and Schwarz's criterion.
  double deviance{};
  double criterion{};
  bool has_converged{};
  double noise{};  // standard deviation of a sample, the geometric mean over decays
};

// Least squares of all decays at once by Gauss-Newton steps on the shared poles; each decay's
// amplitudes are eliminated (Golub & Pereyra 1973). Throws InvalidInput for more unknowns than
// values.
RestingFit fit_resting_poles(const std::vector<NearbyDecay>& decays,
                             const std::vector<RestingPole>& start);

// The first poles without each impact in turn, to first order (one step from the fit of all), for a
// jackknife. As many as different impacts.
std::vector<Pole> without_each_impact(const std::vector<NearbyDecay>& decays,
                                      const RestingFit& fit);
// The standard errors of the first pole's frequency [Hz] and damping ratio that the noise gives.
Pole noise_errors(const std::vector<NearbyDecay>& decays, const RestingFit& fit);

// Deviance and unknowns of a model whose poles are each decay's own (poles[i] of decay i), known.
struct OwnPoles {
  double deviance{};
  double unknowns{};
};
OwnPoles deviance_of_own(const std::vector<NearbyDecay>& decays,
                         const std::vector<std::vector<Pole>>& poles);
// Schwarz's criterion of a deviance with so many unknowns.
double schwarz(double deviance, double unknowns, const std::vector<NearbyDecay>& decays);
}  // namespace tapstudy::analysis
