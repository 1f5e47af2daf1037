#include "analysis/ratings/magnitude.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ranges>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using Means = std::map<double, double>;  // log10 value -> mean log10 estimate

struct Line {
  double slope{};
  double intercept{};
  double r_squared{};
};

void check(const MagnitudeEstimate& one) {
  const auto is_usable = [](double number) { return number > 0.0 && std::isfinite(number); };
  if (!is_usable(one.value) || !is_usable(one.estimate)) {
    throw core::InvalidInput{
        fmt::format("values and estimates of magnitude are finite and above 0, not {} and {}",
                    one.value, one.estimate)};
  }
}

Means means_of(const std::vector<std::pair<double, double>>& points) {
  std::map<double, std::vector<double>> by_value;
  for (const auto& [x, y] : points) {
    by_value[x].push_back(y);
  }
  Means means;
  for (const auto& [x, y] : by_value) {
    means[x] = mean_and_spread(y).mean;
  }
  return means;
}

Means log_means(const Estimates& estimates) {
  std::vector<std::pair<double, double>> points;
  for (const MagnitudeEstimate& one : estimates) {
    check(one);
    points.emplace_back(std::log10(one.value), std::log10(one.estimate));
  }
  Means means = means_of(points);
  if (means.size() < 2) {
    throw core::InvalidInput{fmt::format(
        "an exponent takes estimates of two values or more from each participant, not {}",
        means.size())};
  }
  return means;
}

void check_same_values(const Means& first, const Means& other) {
  if (!std::ranges::equal(std::views::keys(first), std::views::keys(other))) {
    throw core::InvalidInput{"an exponent takes participants who all judged the same values"};
  }
}

double mean_of(const Means& means) {
  double sum = 0.0;
  for (const auto& [x, y] : means) {
    sum += y;
  }
  return sum / static_cast<double>(means.size());
}

Line regression(const Means& means) {
  const double mean_y = mean_of(means);
  double mean_x = 0.0;
  for (const auto& [x, y] : means) {
    mean_x += x / static_cast<double>(means.size());
  }
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (const auto& [x, y] : means) {
    xx += (x - mean_x) * (x - mean_x);
    xy += (x - mean_x) * (y - mean_y);
    yy += (y - mean_y) * (y - mean_y);
  }
  const double slope = xy / xx;
  return {slope, mean_y - slope * mean_x, yy > 0.0 ? xy * slope / yy : 1.0};
}

// All participants' means by value, each shifted to the common mean.
Means equalised(const std::vector<Means>& participants) {
  std::vector<double> own_means;
  for (const Means& means : participants) {
    own_means.push_back(mean_of(means));
  }
  const double common = mean_and_spread(own_means).mean;
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < participants.size(); ++i) {
    for (const auto& [x, y] : participants[i]) {
      points.emplace_back(x, y - own_means[i] + common);
    }
  }
  return means_of(points);
}
}  // namespace

PowerLaw power_law(const std::vector<Estimates>& participants) {
  if (participants.size() < 2) {
    throw core::InvalidInput{fmt::format(
        "an interval of the exponent takes two participants or more, not {}", participants.size())};
  }
  PowerLaw law;
  std::vector<Means> means;
  for (const Estimates& estimates : participants) {
    means.push_back(log_means(estimates));
    check_same_values(means.front(), means.back());
    law.participant_exponents.push_back(regression(means.back()).slope);
  }
  const Means all = equalised(means);
  const Line line = regression(all);
  law.exponent = line.slope;
  law.log_constant = line.intercept;
  law.r_squared = line.r_squared;
  for (const auto& [x, y] : all) {
    law.geometric_means.push_back({std::pow(10.0, x), std::pow(10.0, y)});
  }
  const MeanAndSpread exponents = mean_and_spread(law.participant_exponents);
  const auto n = static_cast<double>(participants.size());
  const double half_width =
      t_quantile(0.975, n - 1.0) * exponents.standard_deviation / std::sqrt(n);
  law.exponent_interval = {exponents.mean - half_width, exponents.mean + half_width};
  return law;
}
}  // namespace tapstudy::analysis
