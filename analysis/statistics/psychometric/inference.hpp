#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/statistics/psychometric/fit.hpp"
namespace tapstudy::analysis {
// Intervals by profile likelihood (Venzon & Moolgavkar 1988): the values whose likelihood,
// maximised over all other parameters, is below the greatest by no more than half the quantile of
// chi-squared with one degree of freedom. An end that the search box does not hold is infinite (0
// for slopes and for thresholds on a logarithmic axis).
struct PsychometricIntervals {
  Interval threshold;
  Interval slope;
};
// Throws InvalidInput as fit_psychometric does, where no threshold was found (an outcome other than
// fitted and step), and for a confidence outside (0, 1).
PsychometricIntervals profile_intervals(const PsychometricModel& model,
                                        const std::vector<Level>& levels, double confidence = 0.95);

// The curve of a fit to these levels that determines a threshold, else nullopt. Where the outcome
// is a step: its threshold is the middle, on the shape's axis, of those that are as likely as the
// likeliest, its slope the steepest that the search box holds; standard errors NaN.
std::optional<PsychometricCurve> curve_with_threshold(const PsychometricModel& model,
                                                      const std::vector<Level>& levels,
                                                      const PsychometricFit& fit);

struct GoodnessOfFit {
  double deviance{};
  double p{};  // (1 + draws with at least this deviance) / (draws + 1): small if the fit is bad
  int draws{};
};
// The deviance against its distribution under the fitted function, by drawing answers anew and
// fitting them (parametric bootstrap; Wichmann & Hill 2001a), because chi-squared is a poor
// approximation for few trials a level. The same seed gives the same p. Throws InvalidInput as
// fit_psychometric does and for draws < 1.
GoodnessOfFit deviance_test(const PsychometricModel& model, const std::vector<Level>& levels,
                            int draws, std::uint64_t seed);

// The places of a posterior's parameters: the threshold's position on the shape's axis, ln width,
// guess rate, lapse rate, eta.
enum PosteriorPlace : std::size_t {
  position_at,
  log_width_at,
  guess_rate_at,
  lapse_rate_at,
  eta_at
};
constexpr std::size_t posterior_parameters = 5;

// Cells of equal width from low to high; one cell if the parameter is fixed (low = high).
struct GridAxis {
  double low{};
  double high{};
  std::size_t cells{1};
  double cell() const { return (high - low) / static_cast<double>(cells); }
  double centre(std::size_t i) const { return low + (static_cast<double>(i) + 0.5) * cell(); }
};
using PosteriorAxes = std::array<GridAxis, posterior_parameters>;
// The probability of each cell of each axis.
using Marginals = std::array<std::vector<double>, posterior_parameters>;

// ln of the prior's density, up to a constant; -infinity where there is none. breadth: of
// psychometric_posterior.
double log_prior_of_position(double position, const AxisRange& range, double breadth = 1.0);
double log_prior_of_width(double width, const AxisRange& range, double breadth = 1.0);
double log_prior_of_rate(double rate);

// The distance on the axis from F = 0.05 to F = 0.95 at a slope of 1.
double width_of_unit_slope(core::PsychometricShape shape);

// A coarse grid over the support of the prior: free parameters with half the cells of a result.
PosteriorAxes prior_axes(const PsychometricModel& model, const std::vector<Level>& levels,
                         double breadth = 1.0);
Marginals marginals_on(const PosteriorAxes& axes, const PsychometricModel& model,
                       const std::vector<Level>& levels, double breadth = 1.0);

// One parameter, the others integrated out.
struct Marginal {
  double mean{};
  double standard_deviation{};
  double median{};
  Interval credible;  // equal tails
  // The middles of the grid's cells, ascending, and the density there: its sum times the distance
  // of two of them is 1. Empty for a fixed parameter.
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
  // That every answer was a guess, at any level, if that was as probable before as a threshold.
  double guessing{};
};

struct PsychometricPosterior {
  FitOutcome outcome{};  // that of the maximum likelihood, a step counting as fitted: the prior
                         // limits the slope
  std::optional<PosteriorEstimates> estimates;  // if fitted; the median may lie outside the levels
};

// The posterior of beta-binomial answers on a grid that is narrowed to where the posterior is
// (Schütt et al. 2016). With levels from low to high, range R = high - low and the smallest gap g
// on the shape's axis, the prior is the product of
//   threshold  1 within [low, high], falling as a raised cosine to 0 at b R/2 outside
//   width      rising as a raised cosine from 0 at g to 1 at 2 g, falling from 1 at b R to 0 at 3 b
//   R guess, lapse  beta(1, 10) within the model's range; eta  beta(1, 10)
// b is the breadth; that of Schütt et al. is 1, for levels chosen to cover the function. Levels of
// an adaptive track cover less of it. Where guesses alone are not less probable than half of what
// the credible interval leaves out, the threshold's upper end is infinite: under them this happens
// to all but as small a share of tracks, whatever the rule by which levels follow answers and the
// track ends (Ville's inequality of likelihood ratios). confidence is that of the credible
// intervals. Throws InvalidInput as fit_psychometric does and
// for a confidence outside (0, 1).
PsychometricPosterior psychometric_posterior(const PsychometricModel& model,
                                             const std::vector<Level>& levels,
                                             double confidence = 0.95, double breadth = 1.0);
}  // namespace tapstudy::analysis
