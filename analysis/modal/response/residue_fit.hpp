#pragma once
#include <complex>
#include <vector>

#include "analysis/modal/response/frequency_responses.hpp"
namespace tapstudy::analysis {
// The modal model (modal_basis.hpp) fitted to all responses at once.
struct ResidueFit {
  std::vector<std::complex<double>> poles;  // [rad/s], upper half plane
  std::vector<Pole> errors;                 // standard errors of frequency and damping ratio
  std::vector<double> degrees_of_freedom;   // of these
  Eigen::MatrixXcd residues;                // of receptance: a row a mode, a column a response
  Eigen::MatrixXd residue_errors;           // standard errors of their parts, likewise
  std::vector<double> significance;         // chi-squared of a mode's residues, 2 a response
  std::vector<double> shares;               // of the responses' energy that the mode's term has
  Eigen::MatrixXcd fitted;                  // as FrequencyResponses::values
};

// Which of the estimates are made: `rough` ones settle sooner and have no errors.
enum class Fitting { rough, complete };

// Residues and residuals by least squares in the frequency domain, poles by variable projection
// (Golub & Pereyra 1973) from these on: maximum likelihood for white noise, of another variance in
// each response, which the residual tells. Standard errors are the larger of the Cramer-Rao bound's
// and of those that hold for noise which varies over frequency, is correlated between responses and
// between two neighbouring lines (Newey & West 1987). A mode's significance is measured against the
// residual near it, which is not taken to be below -100 dB of the response: the chi-squared as
// improbable as its F. Throws InvalidInput for more unknowns than values.
ResidueFit fit_residues(const FrequencyResponses& responses,
                        std::vector<std::complex<double>> poles, Fitting fitting);
}  // namespace tapstudy::analysis
