#include "analysis/psychometric/fit.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

PsychometricCurve curve_of(const BinomialLikelihood& likelihood, const PsychometricBox& box,
                           const PsychometricVector& at) {
  const Eigen::Array4i is_inner = inner_parameters(box, at);
  Eigen::Matrix4d information = likelihood.slopes(at).information;
  for (Eigen::Index i = 0; i < 4; ++i) {
    if (is_inner[i] == 0) {
      information.row(i).setZero();
      information.col(i).setZero();
      information(i, i) = 1.0;
    }
  }
  const Eigen::FullPivLU<Eigen::Matrix4d> factors{information};
  Eigen::Vector4d variances = Eigen::Vector4d::Constant(std::numeric_limits<double>::quiet_NaN());
  if (factors.isInvertible()) {
    variances = factors.inverse().diagonal();
  }
  PsychometricCurve curve;
  curve.threshold = from_axis(likelihood.shape(), at[threshold_at]);
  curve.slope = std::exp(at[log_slope_at]);
  curve.guess = at[guess_at];
  curve.lapse = at[lapse_at];
  curve.threshold_standard_error = std::sqrt(variances[threshold_at]);
  curve.slope_standard_error = curve.slope * std::sqrt(variances[log_slope_at]);
  return curve;
}
}  // namespace

std::string_view explanation(FitOutcome outcome) {
  constexpr std::array<std::string_view, 7> words{
      "a threshold was found",
      "every answer is a success",
      "no answer is a success",
      "the answers do not increase with the value",
      "the answers change within one step between levels, so the slope is not determined",
      "the threshold is below the lowest level",
      "the threshold is above the highest level"};
  return words.at(static_cast<std::size_t>(outcome));
}

PsychometricBox search_box(const PsychometricModel& model, const std::vector<Level>& levels) {
  const AxisRange range = axis_range(levels, model.shape);
  return {{range.low - 3.0 * range.length(), std::log(0.05 / range.length()), model.guess.low,
           model.lapse.low},
          {range.high + 3.0 * range.length(), std::log(50.0 / range.smallest_gap), model.guess.high,
           model.lapse.high}};
}

Maximum greatest(const BinomialLikelihood& likelihood, const PsychometricBox& box,
                 const std::vector<PsychometricVector>& further_starts) {
  const AxisRange range = axis_range(likelihood.levels(), likelihood.shape());
  std::vector<Maximum> starts;
  for (const double along : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    for (const double rise : {1.0, 4.0, 16.0}) {  // slope times range
      for (const double rate : {0.1, 0.5}) {
        const PsychometricVector at =
            PsychometricVector{range.low + along * range.length(), std::log(rise / range.length()),
                               box.low[guess_at] + rate * (box.high[guess_at] - box.low[guess_at]),
                               box.low[lapse_at] + rate * (box.high[lapse_at] - box.low[lapse_at])}
                .cwiseMax(box.low)
                .cwiseMin(box.high);
        starts.push_back({at, likelihood.value(at)});
      }
    }
  }
  std::ranges::partial_sort(starts, starts.begin() + 3, std::ranges::greater{},
                            &Maximum::log_likelihood);
  starts.resize(3);
  for (const PsychometricVector& at : further_starts) {
    starts.push_back({at, 0.0});
  }
  Maximum best{starts.front().at, -std::numeric_limits<double>::infinity()};
  for (const Maximum& start : starts) {
    const Maximum found = climb(likelihood, box, start.at);
    if (found.log_likelihood > best.log_likelihood) {
      best = found;
    }
  }
  return best;
}

PsychometricFit fit_psychometric(const PsychometricModel& model, const std::vector<Level>& levels) {
  check_rates(model);
  const BinomialLikelihood likelihood{model.shape, checked_levels(levels, model.shape)};
  const PsychometricBox box = search_box(model, likelihood.levels());
  PsychometricFit fit;
  fit.maximum = greatest(likelihood, box);
  fit.outcome = outcome_of(model, likelihood, fit.maximum);
  fit.deviance = likelihood.deviance(fit.maximum.at);
  fit.levels = static_cast<int>(likelihood.levels().size());
  fit.free_parameters = static_cast<int>((box.low.array() < box.high.array()).count());
  if (fit.outcome == FitOutcome::fitted) {
    fit.curve = curve_of(likelihood, box, fit.maximum.at);
  }
  return fit;
}
}  // namespace tapstudy::analysis
