#include "analysis/psychometric/binomial_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
namespace tapstudy::analysis {
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

double BinomialLikelihood::shape_value(double x, double threshold, double log_slope) const {
  return core::shape_value(shape_, x, from_axis(shape_, threshold), std::exp(log_slope));
}

std::vector<double> BinomialLikelihood::shape_values(const PsychometricVector& at) const {
  std::vector<double> values;
  for (const Level& level : levels_) {
    values.push_back(shape_value(level.value, at[threshold_at], at[log_slope_at]));
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
  Slopes result{PsychometricVector::Zero(), Eigen::Matrix4d::Zero()};
  const double gain = 1.0 - guess(at) - at[lapse_at];
  const double is_separate = rates_ == Rates::separate ? 1.0 : 0.0;
  const double threshold = from_axis(shape_, at[threshold_at]);
  const double slope = std::exp(at[log_slope_at]);
  for (const Level& level : levels_) {
    const core::ShapeGradient shape = core::shape_gradient(shape_, level.value, threshold, slope);
    const PsychometricVector gradient{gain * shape.by_threshold, gain * shape.by_log_slope,
                                      is_separate * (1.0 - shape.value),
                                      (1.0 - is_separate) * (1.0 - shape.value) - shape.value};
    const double p = std::clamp(guess(at) + gain * shape.value, smallest_p, 1.0 - smallest_p);
    const auto n = static_cast<double>(level.answers.trials);
    const auto k = static_cast<double>(level.answers.successes);
    result.score += (k - n * p) / (p * (1.0 - p)) * gradient;
    result.information += n / (p * (1.0 - p)) * gradient * gradient.transpose();
  }
  return result;
}

double BinomialLikelihood::deviance(const PsychometricVector& at) const {
  double saturated = 0.0;
  for (const Level& level : levels_) {
    saturated += binomial_log_likelihood(level.answers, level.answers.value());
  }
  return std::max(0.0, 2.0 * (saturated - value(at)));
}
}  // namespace tapstudy::analysis
