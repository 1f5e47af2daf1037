#include "analysis/statistics/psychometric/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/statistics/psychometric/maximum_search.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double same_likelihood = 1e-6;  // differences of log-likelihoods below this are none

void check_rates(const PsychometricModel& model) {
  const auto is_range = [](const Interval& rate) {
    return 0.0 <= rate.low && rate.low <= rate.high;
  };
  if (!is_range(model.guess) || !is_range(model.lapse) ||
      !(model.guess.high + model.lapse.high < 1.0)) {
    throw core::InvalidInput{fmt::format(
        "ranges of guess and lapse rate are 0 <= low <= high, and the sum of both is below 1, not "
        "[{}, {}] and [{}, {}]",
        model.guess.low, model.guess.high, model.lapse.low, model.lapse.high)};
  }
}

// The best that a constant proportion within the rates' bounds can do.
double constant_log_likelihood(const PsychometricModel& model, const std::vector<Level>& levels) {
  Proportion all;
  for (const Level& level : levels) {
    all.successes += level.answers.successes;
    all.trials += level.answers.trials;
  }
  const double p = std::clamp(all.value(), model.guess.low, 1.0 - model.lapse.low);
  return binomial_log_likelihood(all, p);
}

// Two parameters take two levels that are neither at the foot nor at the top of the curve.
bool is_step(const BinomialLikelihood& likelihood, const PsychometricVector& at) {
  constexpr double end = 1e-4;
  return std::ranges::count_if(likelihood.shape_values(at),
                               [](double value) { return value > end && value < 1.0 - end; }) < 2;
}

FitOutcome outcome_of(const PsychometricModel& model, const BinomialLikelihood& likelihood,
                      const Maximum& maximum) {
  const auto all_of = [&](auto is_so) { return std::ranges::all_of(likelihood.levels(), is_so); };
  if (all_of([](const Level& level) { return level.answers.successes == level.answers.trials; })) {
    return FitOutcome::all_successes;
  }
  if (all_of([](const Level& level) { return level.answers.successes == 0; })) {
    return FitOutcome::no_successes;
  }
  if (maximum.log_likelihood - constant_log_likelihood(model, likelihood.levels()) <
      same_likelihood) {
    return FitOutcome::no_increase;
  }
  const AxisRange range = axis_range(likelihood.levels(), model.shape);
  if (maximum.at[threshold_at] < range.low) {
    return FitOutcome::threshold_below;
  }
  if (maximum.at[threshold_at] > range.high) {
    return FitOutcome::threshold_above;
  }
  return is_step(likelihood, maximum.at) ? FitOutcome::step : FitOutcome::fitted;
}

PsychometricCurve curve_of(const BinomialLikelihood& likelihood, const PsychometricVector& at) {
  return {from_axis(likelihood.shape(), at[threshold_at]), std::exp(at[log_slope_at]),
          likelihood.guess(at), at[lapse_at]};
}
}  // namespace

std::string_view explanation(FitOutcome outcome) {
  using enum FitOutcome;
  switch (outcome) {
    case fitted:
      return "a threshold was found";
    case all_successes:
      return "every answer is a success";
    case no_successes:
      return "no answer is a success";
    case no_increase:
      return "the answers do not increase with the value";
    case step:
      return "the answers change within one step between levels, so the slope is not determined";
    case threshold_below:
      return "the threshold is below the lowest level";
    case threshold_above:
      return "the threshold is above the highest level";
  }
  return "";
}

BinomialLikelihood likelihood_of(const PsychometricModel& model, const std::vector<Level>& levels) {
  return {model.shape, checked_levels(levels, model.shape), model.rates};
}

PsychometricBox search_box(const PsychometricModel& model, const std::vector<Level>& levels) {
  const AxisRange range = axis_range(levels, model.shape);
  const Interval guess = model.rates == Rates::equal ? Interval{0.0, 0.0} : model.guess;
  return {{range.low - 3.0 * range.length(), std::log(0.05 / range.length()), guess.low,
           model.lapse.low},
          {range.high + 3.0 * range.length(), std::log(50.0 / range.smallest_gap), guess.high,
           model.lapse.high}};
}

PsychometricFit fit_psychometric(const PsychometricModel& model, const std::vector<Level>& levels) {
  check_rates(model);
  const BinomialLikelihood likelihood = likelihood_of(model, levels);
  const PsychometricBox box = search_box(model, likelihood.levels());
  PsychometricFit fit;
  fit.maximum = MaximumSearch{likelihood, box}.maximum(likelihood);
  fit.outcome = outcome_of(model, likelihood, fit.maximum);
  fit.deviance = likelihood.deviance(fit.maximum.at);
  if (fit.outcome == FitOutcome::fitted) {
    fit.curve = curve_of(likelihood, fit.maximum.at);
  }
  return fit;
}
}  // namespace tapstudy::analysis
