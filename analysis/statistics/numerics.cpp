#include "analysis/statistics/numerics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/trigamma.hpp>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::size_t tabulated = 1024;

std::array<double, tabulated> table_of_log_factorials() {
  std::array<double, tabulated> table{};
  for (std::size_t n = 1; n < tabulated; ++n) {
    table[n] = table[n - 1] + std::log(static_cast<double>(n));
  }
  return table;
}
}  // namespace

double log_factorial(std::int64_t n) {
  static const std::array<double, tabulated> table = table_of_log_factorials();
  if (n < static_cast<std::int64_t>(tabulated)) {
    return table[static_cast<std::size_t>(n)];
  }
  const auto x = static_cast<double>(n);
  return (x + 0.5) * std::log(x) - x + 0.5 * std::log(2.0 * std::numbers::pi) + 1.0 / (12.0 * x) -
         1.0 / (360.0 * x * x * x);
}

double integral(const RealFunction& function, double low, double high) {
  constexpr unsigned max_depth = 12;
  constexpr double tolerance = 1e-10;
  return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(function, low, high,
                                                                       max_depth, tolerance);
}

double root(const RealFunction& function, double one_end, double other_end) {
  const double low = std::min(one_end, other_end);
  const double high = std::max(one_end, other_end);
  const double at_low = function(low);
  const double at_high = function(high);
  if (at_low == 0.0 || at_high == 0.0) {
    return at_low == 0.0 ? low : high;
  }
  if (!(at_low * at_high < 0.0)) {
    throw core::InvalidInput{fmt::format("no change of sign between {} and {}", low, high)};
  }
  constexpr int significant_bits = 46;
  std::uintmax_t iterations = 200;
  const auto [left, right] = boost::math::tools::toms748_solve(
      function, low, high, at_low, at_high,
      boost::math::tools::eps_tolerance<double>{significant_bits}, iterations);
  return 0.5 * (left + right);
}

double digamma(double x) {
  return boost::math::digamma(x);
}

double trigamma(double x) {
  return boost::math::trigamma(x);
}

Minimum minimum(const RealFunction& function, double low, double high) {
  constexpr int significant_bits = 20;
  std::uintmax_t iterations = 200;
  const auto [at, value] =
      boost::math::tools::brent_find_minima(function, low, high, significant_bits, iterations);
  return {at, value};
}
}  // namespace tapstudy::analysis
