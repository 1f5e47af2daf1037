#pragma once
#include <optional>
#include <vector>

#include "analysis/modal/decay/decay_model.hpp"
#include "analysis/modal/decay/free_decay.hpp"
namespace tapstudy::analysis {
// One of several decays whose first poles are the same.
struct WeightedDecay {
  DecayModel model;
  DecayModel::State state;
  double weight{1.0};  // of its squares: 1 over the variance of a value of its spectrum
};

// When a fit is settled: a step lowers its sum of squares by no more than this share.
struct Settling {
  double share{};
  int most_steps{};
};
inline constexpr Settling settled_fit{1e-7, 60};

// Variable projection (Golub & Pereyra 1973, Kaufman's approximation) with Levenberg-Marquardt
// steps on the poles until the weighted sum of squares has settled; true if it came to that. The
// first `shared` poles of all decays are the same and remain so; what
// each decay has of its own is eliminated from the normal equations decay by decay (Schur
// complement).
bool descend(std::vector<WeightedDecay>& decays, Eigen::Index shared, const Settling& settling);

// The Fisher information of the shared poles' Re s and Im s [1/s], everything else unknown, too.
Eigen::MatrixXd information_on_shared(const std::vector<WeightedDecay>& decays,
                                      Eigen::Index shared);

// The standard errors of a pole's frequency [Hz] and damping ratio from the covariance of the real
// and imaginary part of its logarithm, ln z or s, in the unit of 1 / unit_s.
Pole errors_of_pole(const std::complex<double>& log_z, const Eigen::Matrix2d& covariance,
                    double unit_s);

// One damped oscillation as fitted: Re(c z^n) = amplitude e^(-decay t) cos(w t + phase).
struct FittedMode {
  Pole pole;
  double amplitude{};  // at the first sample
  double phase_rad{};
  // Standard errors, of white noise in the band
  double frequency_error_hz{};
  double ratio_error{};
  double decay_error_per_s{};
  double amplitude_error{};
  double phase_error_rad{};
  double significance{};  // chi-squared of the amplitude's two parts, 2 degrees of freedom
};

struct DecayFit {
  std::vector<FittedMode> modes;  // as many as poles were given, in their order
  double noise{};                 // standard deviation of a sample, from the residual in the band
  double explained{};             // share of the band's energy
  double sum_of_squares{};        // of the residual in the band, over the real values
  double degrees_of_freedom{};
  bool has_converged{};
  Eigen::VectorXcd fitted;  // the spectrum's values by the modes and the nuisance terms
};

// Sets what the residual of a state says: noise, explained, sum_of_squares, degrees_of_freedom,
// fitted.
void set_residual(const DecayModel& model, const DecayModel::State& state, DecayFit& fit);

// Maximum likelihood in white noise from these poles on (descend, decay_model.hpp). Standard errors
// are those of the Cramer-Rao bound, with the noise of the residual. Steady lines of these
// frequencies, such as hum, take part with amplitudes alone. Throws InvalidInput for more unknowns
// than values.
DecayFit fit_decay(const BandSpectrum& spectrum, const std::vector<Pole>& start,
                   const std::vector<double>& lines_hz = {},
                   const Settling& settling = settled_fit);

// One of several decays that some modes are common to.
struct SharingDecay {
  const BandSpectrum* spectrum{};
  std::vector<Pole> own;  // of its other modes, which need not be those of other decays
  std::vector<double> lines_hz;
  double noise{1.0};  // standard deviation of a sample
};
struct SharedFit {
  // The shared modes first, with the errors of all together, and the significance of their
  // amplitudes where the poles are known.
  std::vector<DecayFit> decays;
  double degrees_of_freedom{};
};
// As fit_decay, for one or more decays that share these poles: only amplitudes differ between them.
SharedFit fit_shared_poles(const std::vector<SharingDecay>& decays,
                           const std::vector<Pole>& shared);

// The shared poles without each group of decays in turn, to first order: one step from the fit of
// all, which these decays and poles are. group_of: of each decay, below `groups`.
std::vector<std::vector<Pole>> shared_poles_without(const std::vector<SharingDecay>& decays,
                                                    const std::vector<Pole>& shared,
                                                    const std::vector<std::size_t>& group_of,
                                                    std::size_t groups);
}  // namespace tapstudy::analysis
