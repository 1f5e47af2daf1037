#include "core/psychometric_function.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
namespace tapstudy::core {
namespace {
using std::numbers::ln10;
using std::numbers::sqrt2;

// S, its derivative and its inverse.
struct StandardForm {
  double (*value)(double z);
  double (*density)(double z);
  double (*quantile)(double value);
};

double logistic_of(double z) {
  return 1.0 / (1.0 + std::exp(-z));
}

constexpr StandardForm extreme_value_form{
    [](double z) { return -std::expm1(-std::exp(ln10 * z)); },
    [](double z) { return ln10 * std::exp(ln10 * z - std::exp(ln10 * z)); },
    [](double value) { return std::log(-std::log1p(-value)) / ln10; }};
constexpr StandardForm logistic_form{logistic_of,
                                     [](double z) { return logistic_of(z) * logistic_of(-z); },
                                     [](double value) { return std::log(value / (1.0 - value)); }};
constexpr StandardForm gaussian_form{
    [](double z) { return 0.5 * std::erfc(-z / sqrt2); },
    [](double z) { return std::numbers::inv_sqrtpi / sqrt2 * std::exp(-0.5 * z * z); },
    [](double value) { return -sqrt2 * boost::math::erfc_inv(2.0 * value); }};

using enum PsychometricShape;
constexpr std::array rows{
    PsychometricShapeRow{weibull, "weibull", true, "Weibull function of the value"},
    PsychometricShapeRow{gumbel, "gumbel", false,
                         "Weibull function of a value given as its logarithm to base 10"},
    PsychometricShapeRow{logistic, "logistic", false, "logistic function of the value"},
    PsychometricShapeRow{log_logistic, "log_logistic", true,
                         "logistic function of the value's logarithm to base 10"},
    PsychometricShapeRow{cumulative_gaussian, "cumulative_gaussian", false,
                         "cumulative Gaussian of the value"},
    PsychometricShapeRow{log_gaussian, "log_gaussian", true,
                         "cumulative Gaussian of the value's logarithm to base 10"},
};
// The standard forms, in the order of the rows.
constexpr std::array forms{extreme_value_form, extreme_value_form, logistic_form,
                           logistic_form,      gaussian_form,      gaussian_form};
static_assert(rows.size() == forms.size());

const StandardForm& form_of(PsychometricShape shape) {
  return forms.at(static_cast<std::size_t>(shape));
}

void check(const PsychometricShapeRow& row, double threshold, double slope) {
  if (!(slope > 0.0) || !std::isfinite(slope)) {
    throw InvalidInput{
        fmt::format("{}: a slope is a finite number above 0, not {}", row.name, slope)};
  }
  if (!std::isfinite(threshold) || (row.is_logarithmic && threshold <= 0.0)) {
    throw InvalidInput{fmt::format("{}: a threshold is a finite number{}, not {}", row.name,
                                   row.is_logarithmic ? " above 0" : "", threshold)};
  }
}

void check_rates(double guess, double lapse) {
  if (!(guess >= 0.0 && lapse >= 0.0 && guess + lapse < 1.0)) {
    throw InvalidInput{
        fmt::format("guess and lapse rate are at least 0 and their sum is below 1, not {} and {}",
                    guess, lapse)};
  }
}

// a(x) - a(threshold)
double distance_on_axis(PsychometricShape shape, double x, double threshold, double slope) {
  const PsychometricShapeRow& row = row_of(shape);
  check(row, threshold, slope);
  if (std::isnan(x) || (row.is_logarithmic && x < 0.0)) {
    throw InvalidInput{fmt::format("{}: a value is a number{}, not {}", row.name,
                                   row.is_logarithmic ? " of at least 0" : "", x)};
  }
  return row.is_logarithmic ? std::log10(x / threshold) : x - threshold;
}
}  // namespace

std::span<const PsychometricShapeRow> psychometric_shapes() {
  return rows;
}

const PsychometricShapeRow* find_psychometric_shape(std::string_view name) {
  const auto* const found = std::ranges::find(rows, name, &PsychometricShapeRow::name);
  return found == rows.end() ? nullptr : &*found;
}

const PsychometricShapeRow& row_of(PsychometricShape shape) {
  return rows.at(static_cast<std::size_t>(shape));
}

std::vector<std::string> psychometric_shape_names() {
  std::vector<std::string> names;
  for (const PsychometricShapeRow& row : rows) {
    names.emplace_back(row.name);
  }
  return names;
}

double shape_value(PsychometricShape shape, double x, double threshold, double slope) {
  return form_of(shape).value(slope * distance_on_axis(shape, x, threshold, slope));
}

ShapeGradient shape_gradient(PsychometricShape shape, double x, double threshold, double slope) {
  const double z = slope * distance_on_axis(shape, x, threshold, slope);
  const double density = form_of(shape).density(z);
  // where S no longer grows, z may be infinite
  return {form_of(shape).value(z), -slope * density, density == 0.0 ? 0.0 : z * density};
}

double shape_quantile(PsychometricShape shape, double value, double threshold, double slope) {
  const PsychometricShapeRow& row = row_of(shape);
  check(row, threshold, slope);
  if (!(value > 0.0 && value < 1.0)) {
    throw InvalidInput{fmt::format("{}: F is reached between 0 and 1, not at {}", row.name, value)};
  }
  const double distance = form_of(shape).quantile(value) / slope;
  return row.is_logarithmic ? threshold * std::pow(10.0, distance) : threshold + distance;
}

double proportion(PsychometricShape shape, double x, double threshold, double slope, double guess,
                  double lapse) {
  check_rates(guess, lapse);
  return guess + (1.0 - guess - lapse) * shape_value(shape, x, threshold, slope);
}

double value_at_proportion(PsychometricShape shape, double level, double threshold, double slope,
                           double guess, double lapse) {
  check_rates(guess, lapse);
  if (!(level > guess && level < 1.0 - lapse)) {
    throw InvalidInput{fmt::format("a proportion between {} and {} is reached, not {}", guess,
                                   1.0 - lapse, level)};
  }
  return shape_quantile(shape, (level - guess) / (1.0 - guess - lapse), threshold, slope);
}
}  // namespace tapstudy::core
