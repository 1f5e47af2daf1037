#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>
namespace tapstudy::core {
// Psychometric functions: the proportion of one answer ("correct", "stronger") as a function of a
// stimulus's value x (Wichmann & Hill 2001a, eq. 1):
//
//   psi(x) = guess + (1 - guess - lapse) F(x; threshold, slope)
//
// F = S(slope (a(x) - a(threshold))) with a standard form S(z), increasing from 0 to 1, on an axis
// a, which is x itself or log10 x:
//
//   name                 S(z)               axis    F(threshold)
//   gumbel               1 - exp(-10^z)     x       1 - 1/e
//   weibull              1 - exp(-10^z)     log10   1 - 1/e   = 1 - exp(-(x/threshold)^slope)
//   logistic             1 / (1 + exp(-z))  x       1/2
//   log_logistic         1 / (1 + exp(-z))  log10   1/2
//   cumulative_gaussian  Phi(z)             x       1/2
//   log_gaussian         Phi(z)             log10   1/2
//
// threshold: where F is the value above, in the unit of x in every shape (> 0 on the log10 axis).
// slope: > 0, per unit of the axis; steeper is greater. weibull: its exponent; gumbel: that of the
//   Weibull whose logarithm x is, so decibels are x/20 (Watson 2017; measures of slope: Strasburger
//   2001). Gaussian shapes: 1/sigma. Parameters are those of Kingdom & Prins 2016.
// x: any number; on the log10 axis x >= 0, and F(0) = 0.
enum class PsychometricShape {
  weibull,
  gumbel,
  logistic,
  log_logistic,
  cumulative_gaussian,
  log_gaussian
};

struct PsychometricShapeRow {
  PsychometricShape shape{};
  std::string_view name;
  bool is_logarithmic{};  // the axis is log10 x
  std::string_view summary;
};
// All shapes, in the order of PsychometricShape.
std::span<const PsychometricShapeRow> psychometric_shapes();
// nullptr if there is none of that name.
const PsychometricShapeRow* find_psychometric_shape(std::string_view name);
const PsychometricShapeRow& row_of(PsychometricShape shape);
std::vector<std::string> psychometric_shape_names();

// F(x; threshold, slope). Throws InvalidInput for parameters and x that the shape does not allow.
double shape_value(PsychometricShape shape, double x, double threshold, double slope);
// F with its derivatives, likewise.
struct ShapeGradient {
  double value{};
  double by_threshold{};  // by a(threshold)
  double by_log_slope{};
};
ShapeGradient shape_gradient(PsychometricShape shape, double x, double threshold, double slope);
// The x at which F is `value`, 0 < value < 1. Throws InvalidInput.
double shape_quantile(PsychometricShape shape, double value, double threshold, double slope);

// psi(x). guess and lapse in [0, 1), their sum below 1. Throws InvalidInput.
double proportion(PsychometricShape shape, double x, double threshold, double slope, double guess,
                  double lapse);
// The x at which psi is `level`, guess < level < 1 - lapse. Throws InvalidInput.
double value_at_proportion(PsychometricShape shape, double level, double threshold, double slope,
                           double guess, double lapse);
}  // namespace tapstudy::core
