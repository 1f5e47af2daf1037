#pragma once
#include <optional>
#include <string>
#include <vector>

#include "analysis/modal/decay/estimate.hpp"
#include "analysis/modal/modes/tap_modes.hpp"
#include "analysis/modal/response/residue_fit.hpp"
#include "analysis/modal/response/stabilisation.hpp"
namespace tapstudy::analysis {
// One mode of all responses together.
struct ResponseMode {
  Estimate frequency_hz;
  Estimate damping_ratio;
  double degrees_of_freedom{};  // of their standard errors
  Standing standing{Standing::agreed};
  std::string why;        // where it is doubtful
  int orders{};           // successive orders that have its pole
  double significance{};  // as ResidueFit's
  double share{};         // likewise
  // Displacements of the places, the largest 1, turned in phase to be as real as they can be.
  Eigen::VectorXcd shape;
  // 1: all places move in phase or against it, as those of a structure without localised damping
  // (modal phase collinearity, Pappa, Elliott & Schenk 1993).
  double phase_collinearity{};
  Eigen::VectorXcd residues;  // of receptance, for each pair
};

struct ResponseModes {
  FrequencyResponses measured;      // inside the band
  Eigen::MatrixXcd fitted;          // as measured.values
  std::vector<std::string> places;  // of shapes
  std::vector<StabilisationOrder> diagram;
  std::vector<ResponseMode> modes;  // ascending frequency, inside the band
  std::vector<std::string> remarks;
};

// Modes of frequency responses inside the band, by default all of their frequencies: poles of the
// least-squares complex frequency-domain estimator (normal_equations.hpp) that settle over model
// orders (stabilisation.hpp), refined together with their residues by maximum likelihood
// (residue_fit.hpp); those whose residues are not significant are dropped, the weakest first. A
// mode is doubtful if the interval of its damping ratio reaches 0 or that of its frequency is wider
// than a tenth of it, if half of its peak lies outside the band, if its half-power bandwidth is
// below a tenth of the step between two frequencies, or if it is a remainder of a stronger one:
// within their bandwidths, of its shape (a modal assurance above 0.9) and of less than a quarter of
// its energy. A bandwidth below a step is remarked on. Throws InvalidInput as within and
// fit_residues do.
ResponseModes find_response_modes(const FrequencyResponses& responses,
                                  const std::optional<Band>& band);
}  // namespace tapstudy::analysis
