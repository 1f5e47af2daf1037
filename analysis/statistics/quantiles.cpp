#include "analysis/statistics/quantiles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
namespace tapstudy::analysis {
double quantile(std::vector<double> values, double probability) {
  if (values.empty() || std::ranges::any_of(values, [](double x) { return std::isnan(x); })) {
    throw core::InvalidInput{"a quantile takes one value or more, and every value is a number"};
  }
  if (!(probability >= 0.0 && probability <= 1.0)) {
    throw core::InvalidInput{fmt::format("a probability is between 0 and 1, not {}", probability)};
  }
  const double place = probability * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::ptrdiff_t>(place);
  const double along = place - static_cast<double>(below);
  const auto at = values.begin() + below;
  std::ranges::nth_element(values, at);
  return along == 0.0 ? *at : *at + along * (*std::min_element(at + 1, values.end()) - *at);
}

Quartiles quartiles(const std::vector<double>& values) {
  return {quantile(values, 0.25), quantile(values, 0.5), quantile(values, 0.75)};
}

MeanAndSpread mean_and_spread(std::span<const double> values) {
  if (values.empty()) {
    throw core::InvalidInput{"a mean takes one value or more"};
  }
  const auto n = static_cast<double>(values.size());
  MeanAndSpread result;
  for (const double value : values) {
    result.mean += value / n;
  }
  // rounding would leave equal values a mean that is none of them, and a deviation
  const auto [least, most] = std::ranges::minmax(values);
  result.mean = std::clamp(result.mean, least, most);
  double squares = 0.0;
  for (const double value : values) {
    squares += (value - result.mean) * (value - result.mean);
  }
  result.standard_deviation = std::sqrt(squares / (n - 1.0));
  return result;
}
}  // namespace tapstudy::analysis
