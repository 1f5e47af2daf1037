#include "analysis/psychometric/posterior.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/psychometric/posterior_grid.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
// From the first to the last cell that is not negligible, and one further on either side.
GridAxis narrowed(const GridAxis& axis, const std::vector<double>& marginal) {
  const double negligible = 1e-5 * *std::ranges::max_element(marginal);
  const auto is_kept = [&](double probability) { return probability > negligible; };
  const auto first = std::ranges::find_if(marginal, is_kept) - marginal.begin();
  const auto last =
      std::find_if(marginal.rbegin(), marginal.rend(), is_kept).base() - marginal.begin();
  return {std::max(axis.low, axis.low + static_cast<double>(first - 1) * axis.cell()),
          std::min(axis.high, axis.low + static_cast<double>(last + 1) * axis.cell()), axis.cells};
}

// Each cell's probability lies evenly in it.
double quantile_on(const GridAxis& axis, const std::vector<double>& marginal, double probability) {
  double below = 0.0;
  for (std::size_t i = 0; i < marginal.size(); ++i) {
    if (below + marginal[i] >= probability) {
      const double along = marginal[i] > 0.0 ? (probability - below) / marginal[i] : 0.0;
      return axis.low + (static_cast<double>(i) + along) * axis.cell();
    }
    below += marginal[i];
  }
  return axis.high;
}

Marginal summary(const GridAxis& axis, const std::vector<double>& marginal, double confidence) {
  Marginal result;
  for (std::size_t i = 0; i < marginal.size(); ++i) {
    result.mean += marginal[i] * axis.centre(i);
  }
  double variance = 0.0;
  for (std::size_t i = 0; i < marginal.size(); ++i) {
    variance += marginal[i] * std::pow(axis.centre(i) - result.mean, 2.0);
  }
  result.standard_deviation = std::sqrt(variance);
  for (std::size_t i = 0; axis.cells > 1 && i < marginal.size(); ++i) {
    result.at.push_back(axis.centre(i));
    result.density.push_back(marginal[i] / axis.cell());
  }
  result.median = quantile_on(axis, marginal, 0.5);
  result.credible = {quantile_on(axis, marginal, 0.5 * (1.0 - confidence)),
                     quantile_on(axis, marginal, 0.5 * (1.0 + confidence))};
  return result;
}

PosteriorEstimates estimates_of(const PsychometricModel& model, const std::vector<Level>& levels,
                                double confidence) {
  constexpr int narrowings = 3;
  PosteriorAxes axes = prior_axes(model, levels);
  Marginals marginals = marginals_on(axes, model, levels);
  for (int narrowing = 1; narrowing <= narrowings; ++narrowing) {
    for (std::size_t axis = 0; axis < posterior_parameters; ++axis) {
      axes[axis] = narrowed(axes[axis], marginals[axis]);
      const bool is_last = narrowing == narrowings && axes[axis].cells > 1;
      axes[axis].cells *= is_last ? 2 : 1;
    }
    marginals = marginals_on(axes, model, levels);
  }
  const auto at = [&](std::size_t axis) {
    return summary(axes[axis], marginals[axis], confidence);
  };
  PosteriorEstimates result{at(position_at),
                            at(log_width_at),
                            at(guess_rate_at),
                            at(lapse_rate_at),
                            at(eta_at),
                            0.0,
                            {},
                            0.0,
                            {}};
  const auto value_at = [&](double position) { return from_axis(model.shape, position); };
  const auto slope_at = [&](double log_width) {
    return width_of_unit_slope(model.shape) / std::exp(log_width);
  };
  const Interval& position = result.position.credible;
  result.threshold = value_at(result.position.median);
  result.threshold_interval = {value_at(position.low), value_at(position.high)};
  result.slope = slope_at(result.log_width.median);
  result.slope_interval = {slope_at(result.log_width.credible.high),
                           slope_at(result.log_width.credible.low)};
  return result;
}
}  // namespace

PsychometricPosterior psychometric_posterior(const PsychometricModel& model,
                                             const std::vector<Level>& levels, double confidence) {
  if (!(confidence > 0.0 && confidence < 1.0)) {
    throw core::InvalidInput{fmt::format("a confidence is between 0 and 1, not {}", confidence)};
  }
  PsychometricPosterior posterior;
  posterior.outcome = fit_psychometric(model, levels).outcome;
  if (posterior.outcome == FitOutcome::step) {
    posterior.outcome = FitOutcome::fitted;
  }
  if (posterior.outcome != FitOutcome::fitted) {
    return posterior;
  }
  posterior.estimates = estimates_of(model, checked_levels(levels, model.shape), confidence);
  return posterior;
}
}  // namespace tapstudy::analysis
