#include "analysis/statistics/population/test_retest.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double tail = 0.025;

void check(const std::vector<std::vector<double>>& occasions) {
  const auto is_wrong = [&](const std::vector<double>& values) {
    return values.size() < 2 || values.size() != occasions.front().size() ||
           !std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
  };
  if (occasions.size() < 2 || std::ranges::any_of(occasions, is_wrong)) {
    throw core::InvalidInput{
        "measurements are repeated by two people or more, each at two occasions or more, with "
        "finite values"};
  }
}

// Of people in rows and occasions in columns.
struct MeanSquares {
  double people{};
  double occasions{};
  double residual{};
};

MeanSquares mean_squares(const std::vector<std::vector<double>>& occasions) {
  const std::size_t people = occasions.front().size();
  const auto n = static_cast<double>(people);
  const auto k = static_cast<double>(occasions.size());
  std::vector<double> of_people(people, 0.0);
  std::vector<double> of_occasions;
  for (const std::vector<double>& values : occasions) {
    of_occasions.push_back(mean_and_spread(values).mean);
    for (std::size_t i = 0; i < people; ++i) {
      of_people[i] += values[i] / k;
    }
  }
  const double all = mean_and_spread(of_occasions).mean;
  MeanSquares squares;
  for (std::size_t j = 0; j < occasions.size(); ++j) {
    squares.occasions += n * std::pow(of_occasions[j] - all, 2) / (k - 1.0);
    for (std::size_t i = 0; i < people; ++i) {
      const double left = occasions[j][i] - of_people[i] - of_occasions[j] + all;
      squares.residual += left * left / ((n - 1.0) * (k - 1.0));
    }
  }
  for (const double mean : of_people) {
    squares.people += k * std::pow(mean - all, 2) / (n - 1.0);
  }
  return squares;
}

Interval interval_of(const MeanSquares& squares, double value, double n, double k) {
  const double a = k * value / (n * (1.0 - value));
  const double b = 1.0 + k * value * (n - 1.0) / (n * (1.0 - value));
  const double of_occasions = a * squares.occasions;
  const double of_residual = b * squares.residual;
  const double freedom =
      std::pow(of_occasions + of_residual, 2) /
      (std::pow(of_occasions, 2) / (k - 1.0) + std::pow(of_residual, 2) / ((n - 1.0) * (k - 1.0)));
  const double of_rest = k * squares.occasions + (k * n - k - n) * squares.residual;
  const double above = f_quantile(1.0 - tail, n - 1.0, freedom);
  const double below = f_quantile(1.0 - tail, freedom, n - 1.0);
  return {n * (squares.people - above * squares.residual) / (above * of_rest + n * squares.people),
          n * (below * squares.people - squares.residual) / (of_rest + n * below * squares.people)};
}
}  // namespace

LimitsOfAgreement limits_of_agreement(const std::vector<double>& first,
                                      const std::vector<double>& second) {
  check({first, second});
  std::vector<double> differences;
  for (std::size_t i = 0; i < first.size(); ++i) {
    differences.push_back(second[i] - first[i]);
  }
  const auto [mean, spread] = mean_and_spread(differences);
  const double reach = -normal_quantile(tail);
  LimitsOfAgreement found{mean,
                          std::nullopt,
                          {mean - reach * spread, mean + reach * spread},
                          std::nullopt,
                          std::nullopt};
  if (spread > 0.0) {
    const double root = std::sqrt(static_cast<double>(differences.size()));
    const double freedom = static_cast<double>(differences.size()) - 1.0;
    const double near = spread / root * noncentral_t_quantile(tail, freedom, reach * root);
    const double far = spread / root * noncentral_t_quantile(1.0 - tail, freedom, reach * root);
    found.mean_interval = t_interval(differences);
    found.low_interval = Interval{mean - far, mean - near};
    found.high_interval = Interval{mean + near, mean + far};
  }
  return found;
}

namespace {
constexpr double rounding = 1e-24;  // of squares, in proportion
}  // namespace

bool do_people_differ(const std::vector<std::vector<double>>& occasions) {
  check(occasions);
  double largest = 0.0;
  for (const std::vector<double>& values : occasions) {
    for (const double value : values) {
      largest = std::max(largest, value * value);
    }
  }
  return mean_squares(occasions).people > rounding * largest;
}

std::optional<IntraclassCorrelation> intraclass_correlation(
    const std::vector<std::vector<double>>& occasions) {
  const bool differ = do_people_differ(occasions);
  const MeanSquares squares = mean_squares(occasions);
  const auto n = static_cast<double>(occasions.front().size());
  const auto k = static_cast<double>(occasions.size());
  const double scale = squares.people + squares.occasions + squares.residual;
  if (!differ || squares.residual <= rounding * scale) {
    return std::nullopt;
  }
  const double value =
      (squares.people - squares.residual) / (squares.people + (k - 1.0) * squares.residual +
                                             k / n * (squares.occasions - squares.residual));
  return IntraclassCorrelation{value, interval_of(squares, value, n, k)};
}
}  // namespace tapstudy::analysis
