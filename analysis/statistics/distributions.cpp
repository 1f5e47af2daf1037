#include "analysis/statistics/distributions.hpp"

#include <fmt/format.h>

#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/gamma.hpp>
#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
void check_probability(double probability) {
  if (!(probability >= 0.0 && probability <= 1.0)) {
    throw core::InvalidInput{fmt::format("a probability is between 0 and 1, not {}", probability)};
  }
}

void check_degrees(double degrees_of_freedom) {
  if (!(degrees_of_freedom > 0.0)) {
    throw core::InvalidInput{
        fmt::format("degrees of freedom are above 0, not {}", degrees_of_freedom)};
  }
}
}  // namespace

double normal_density(double z) {
  return std::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
}

double normal_cdf(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

double normal_quantile(double probability) {
  check_probability(probability);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (probability == 0.0) {
    return -infinity;
  }
  return probability == 1.0 ? infinity : boost::math::quantile(boost::math::normal{}, probability);
}

double chi_squared_p(double x, double degrees_of_freedom) {
  check_degrees(degrees_of_freedom);
  const boost::math::chi_squared distribution{degrees_of_freedom};
  return x > 0.0 ? boost::math::cdf(boost::math::complement(distribution, x)) : 1.0;
}

double f_p(double f, double numerator_freedom, double denominator_freedom) {
  check_degrees(numerator_freedom);
  check_degrees(denominator_freedom);
  const boost::math::fisher_f distribution{numerator_freedom, denominator_freedom};
  return f > 0.0 ? boost::math::cdf(boost::math::complement(distribution, f)) : 1.0;
}

double f_quantile(double probability, double numerator_freedom, double denominator_freedom) {
  check_probability(probability);
  check_degrees(numerator_freedom);
  check_degrees(denominator_freedom);
  return boost::math::quantile(boost::math::fisher_f{numerator_freedom, denominator_freedom},
                               probability);
}

double gamma_quantile(double probability, double shape) {
  check_probability(probability);
  check_degrees(shape);
  return boost::math::quantile(boost::math::gamma_distribution<>{shape}, probability);
}

double beta_quantile(double probability, double first_shape, double second_shape) {
  check_probability(probability);
  check_degrees(first_shape);
  check_degrees(second_shape);
  return boost::math::quantile(boost::math::beta_distribution<>{first_shape, second_shape},
                               probability);
}

double chi_squared_quantile(double probability, double degrees_of_freedom) {
  check_probability(probability);
  check_degrees(degrees_of_freedom);
  return boost::math::quantile(boost::math::chi_squared{degrees_of_freedom}, probability);
}

double t_quantile(double probability, double degrees_of_freedom) {
  check_probability(probability);
  check_degrees(degrees_of_freedom);
  return boost::math::quantile(boost::math::students_t{degrees_of_freedom}, probability);
}

double noncentral_t_quantile(double probability, double degrees_of_freedom, double noncentrality) {
  check_probability(probability);
  check_degrees(degrees_of_freedom);
  return boost::math::quantile(boost::math::non_central_t{degrees_of_freedom, noncentrality},
                               probability);
}

double normal_two_sided_p(double z) {
  return std::erfc(std::abs(z) / std::numbers::sqrt2);
}
}  // namespace tapstudy::analysis
