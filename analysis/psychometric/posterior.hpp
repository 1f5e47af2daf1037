#pragma once
#include <optional>
#include <vector>

#include "analysis/psychometric/fit.hpp"
namespace tapstudy::analysis {
// One parameter, the others integrated out.
struct Marginal {
  double mean{};
  double standard_deviation{};
  double median{};
  Interval credible;  // equal tails
  // The middles of the grid's cells, ascending, and the density there: its sum times the distance
  // of two of them is 1. Of a fixed parameter empty.
  std::vector<double> at{};
  std::vector<double> density{};
};

struct PosteriorEstimates {
  Marginal position;   // of the threshold on the shape's axis (log10 x on a logarithmic one)
  Marginal log_width;  // ln of the distance on the axis from F = 0.05 to F = 0.95
  Marginal guess;      // fixed rates have no spread
  Marginal lapse;
  Marginal eta;  // over-dispersion: 0 is binomial
  // Medians and intervals of the above in the units of core/psychometric_function.hpp.
  double threshold{};
  Interval threshold_interval;
  double slope{};
  Interval slope_interval;
};

struct PsychometricPosterior {
  FitOutcome outcome{};  // that of the maximum likelihood, a step counting as fitted: the prior
                         // limits the slope
  std::optional<PosteriorEstimates> estimates;  // if fitted; the median may lie outside the levels
};

// The posterior of beta-binomial answers on a grid that is narrowed to where the posterior is
// (Schütt et al. 2016). With levels from low to high, range R = high - low and the smallest gap g
// on the shape's axis, the prior is the product of
//   threshold  1 within [low, high], falling as a raised cosine to 0 at R/2 outside
//   width      rising as a raised cosine from 0 at g to 1 at 2 g, falling from 1 at R to 0 at 3 R
//   guess, lapse  beta(1, 10) within the model's range; eta  beta(1, 10)
// confidence is that of the credible intervals. Throws InvalidInput as fit_psychometric does and
// for a confidence outside (0, 1).
PsychometricPosterior psychometric_posterior(const PsychometricModel& model,
                                             const std::vector<Level>& levels,
                                             double confidence = 0.95);
}  // namespace tapstudy::analysis
