#include "analysis/statistics/psychometric/likelihood.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double smallest_mean = 1e-12;  // beta distributions have no mean of 0 or 1
}  // namespace

double beta_binomial_log_likelihood(const Proportion& answers, double p, double eta) {
  constexpr double smallest_eta = 1e-4;  // below, rounding exceeds the difference from binomial
  const double mean = std::clamp(p, smallest_mean, 1.0 - smallest_mean);
  if (eta < smallest_eta) {
    return binomial_log_likelihood(answers, mean);
  }
  const double nu = 1.0 / (eta * eta) - 1.0;
  const auto n = static_cast<double>(answers.trials);
  const auto k = static_cast<double>(answers.successes);
  const double a = nu * mean;
  const double b = nu * (1.0 - mean);
  constexpr std::int64_t most_factors = 20;  // products do not underflow, and cost less
  if (answers.trials <= most_factors) {
    double product = 1.0;
    for (double i = 0.0; i < k; i += 1.0) {
      product *= (a + i) / (nu + i);
    }
    for (double i = 0.0; i < n - k; i += 1.0) {
      product *= (b + i) / (nu + k + i);
    }
    return std::log(product);
  }
  return std::lgamma(k + a) - std::lgamma(a) + std::lgamma(n - k + b) - std::lgamma(b) +
         std::lgamma(nu) - std::lgamma(n + nu);
}

BetaBinomialLikelihood::BetaBinomialLikelihood(const std::vector<Level>& levels,
                                               const Eigen::ArrayXd& etas)
    : levels_{levels},
      nu_{etas.square().inverse() - 1.0},
      product_{etas.size()},
      sum_{etas.size()} {
  std::int64_t most = 0;
  for (const Level& level : levels) {
    most = std::max(most, level.answers.trials);
  }
  for (std::int64_t i = 0; i < most; ++i) {
    inverse_.emplace_back((nu_ + static_cast<double>(i)).inverse());
  }
}

// A logarithm costs as much as ten products, which are therefore taken together. No factor is above
// 1 or below the smallest mean, so that twenty more do not underflow.
void BetaBinomialLikelihood::multiply(double mean, std::int64_t count, std::int64_t from) {
  constexpr std::int64_t most_factors = 20;
  constexpr double small = 1e-60;
  for (std::int64_t i = 0; i < count; ++i) {
    product_ *=
        (nu_ * mean + static_cast<double>(i)) * inverse_[static_cast<std::size_t>(from + i)];
    if ((i + 1 == count || (i + 1) % most_factors == 0) && product_.minCoeff() < small) {
      sum_ += product_.log();
      product_.setOnes();
    }
  }
}

const Eigen::ArrayXd& BetaBinomialLikelihood::log_likelihoods(const std::vector<double>& p) {
  sum_.setZero();
  product_.setOnes();
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const double mean = std::clamp(p[i], smallest_mean, 1.0 - smallest_mean);
    const Proportion& answers = levels_[i].answers;
    multiply(mean, answers.successes, 0);
    multiply(1.0 - mean, answers.trials - answers.successes, answers.successes);
  }
  sum_ += product_.log();
  return sum_;
}

namespace {
void check(const Level& level, const core::PsychometricShapeRow& row) {
  if (level.answers.trials < 0 || level.answers.successes < 0 ||
      level.answers.successes > level.answers.trials) {
    throw core::InvalidInput{fmt::format("at {}: {} of {} answers are not possible", level.value,
                                         level.answers.successes, level.answers.trials)};
  }
  if (!std::isfinite(level.value) || (row.is_logarithmic && level.value < 0.0)) {
    throw core::NotEstimable{fmt::format("{}: a value is a finite number{}, not {}", row.name,
                                         row.is_logarithmic ? " of at least 0" : "", level.value)};
  }
}
}  // namespace

std::vector<Level> checked_levels(const std::vector<Level>& levels, core::PsychometricShape shape) {
  const core::PsychometricShapeRow& row = core::row_of(shape);
  std::vector<Level> sorted = levels;
  std::ranges::sort(sorted, {}, &Level::value);
  std::vector<Level> merged;
  for (const Level& level : sorted) {
    check(level, row);
    if (level.answers.trials == 0) {
      continue;
    }
    if (!merged.empty() && merged.back().value == level.value) {
      merged.back().answers.successes += level.answers.successes;
      merged.back().answers.trials += level.answers.trials;
    } else {
      merged.push_back(level);
    }
  }
  const auto usable = std::ranges::count_if(
      merged, [&](const Level& level) { return !row.is_logarithmic || level.value > 0.0; });
  if (usable < 2) {
    throw core::NotEstimable{fmt::format(
        "{}: a psychometric function takes answers at two different values{} or more, not {}",
        row.name, row.is_logarithmic ? " above 0" : "", usable)};
  }
  return merged;
}

double on_axis(core::PsychometricShape shape, double value) {
  return core::row_of(shape).is_logarithmic ? std::log10(value) : value;
}

double from_axis(core::PsychometricShape shape, double position) {
  return core::row_of(shape).is_logarithmic ? std::pow(10.0, position) : position;
}

AxisRange axis_range(const std::vector<Level>& levels, core::PsychometricShape shape) {
  AxisRange range{0.0, 0.0, std::numeric_limits<double>::infinity()};
  bool is_first = true;
  for (const Level& level : levels) {
    const double position = on_axis(shape, level.value);
    if (!std::isfinite(position)) {
      continue;
    }
    if (is_first) {
      range.low = position;
    } else {
      range.smallest_gap = std::min(range.smallest_gap, position - range.high);
    }
    range.high = position;
    is_first = false;
  }
  constexpr double rounding = 1e-6;  // levels nearer than this are no step apart
  range.smallest_gap = std::max(range.smallest_gap, rounding * range.length());
  return range;
}

namespace {
constexpr double smallest_p = 1e-15;  // keeps the weights of the information finite

double times_log(std::int64_t count, double p) {
  return count == 0 ? 0.0 : static_cast<double>(count) * std::log(p);
}
}  // namespace

double binomial_log_likelihood(const Proportion& answers, double p) {
  return times_log(answers.successes, p) + times_log(answers.trials - answers.successes, 1.0 - p);
}

BinomialLikelihood::BinomialLikelihood(core::PsychometricShape shape, std::vector<Level> levels,
                                       Rates rates)
    : shape_{shape}, levels_{std::move(levels)}, rates_{rates} {}

std::vector<double> BinomialLikelihood::shape_values(const PsychometricVector& at) const {
  const double threshold = from_axis(shape_, at[threshold_at]);
  const double slope = std::exp(at[log_slope_at]);
  std::vector<double> values;
  values.reserve(levels_.size());
  for (const Level& level : levels_) {
    values.push_back(core::shape_value(shape_, level.value, threshold, slope));
  }
  return values;
}

std::vector<double> BinomialLikelihood::proportions(const PsychometricVector& at) const {
  std::vector<double> values = shape_values(at);
  for (double& value : values) {
    value = guess(at) + (1.0 - guess(at) - at[lapse_at]) * value;
  }
  return values;
}

double BinomialLikelihood::value(const PsychometricVector& at) const {
  const std::vector<double> p = proportions(at);
  double sum = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    sum += binomial_log_likelihood(levels_[i].answers, p[i]);
  }
  return sum;
}

BinomialLikelihood::Slopes BinomialLikelihood::slopes(const PsychometricVector& at) const {
  Slopes result;
  const double gain = 1.0 - guess(at) - at[lapse_at];
  const double is_separate = rates_ == Rates::separate ? 1.0 : 0.0;
  const double threshold = from_axis(shape_, at[threshold_at]);
  const double slope = std::exp(at[log_slope_at]);
  for (const Level& level : levels_) {
    const core::ShapeGradient shape = core::shape_gradient(shape_, level.value, threshold, slope);
    const PsychometricVector gradient{gain * shape.by_threshold, gain * shape.by_log_slope,
                                      is_separate * (1.0 - shape.value),
                                      (1.0 - is_separate) * (1.0 - shape.value) - shape.value};
    const double proportion = guess(at) + gain * shape.value;
    result.log_likelihood += binomial_log_likelihood(level.answers, proportion);
    const double p = std::clamp(proportion, smallest_p, 1.0 - smallest_p);
    const auto n = static_cast<double>(level.answers.trials);
    const auto k = static_cast<double>(level.answers.successes);
    result.score += (k - n * p) / (p * (1.0 - p)) * gradient;
    result.information += n / (p * (1.0 - p)) * gradient * gradient.transpose();
  }
  return result;
}

double BinomialLikelihood::saturated() const {
  double sum = 0.0;
  for (const Level& level : levels_) {
    sum += binomial_log_likelihood(level.answers, level.answers.value());
  }
  return sum;
}

double BinomialLikelihood::deviance(const PsychometricVector& at) const {
  return std::max(0.0, 2.0 * (saturated() - value(at)));
}
}  // namespace tapstudy::analysis
