#include "analysis/statistics/scaling/power_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using Means = std::map<double, double>;  // log10 value -> mean log10 estimate

struct Line {
  double slope{};
  double intercept{};
  std::optional<double> r_squared;
};

void check(const MagnitudeEstimate& one) {
  const auto is_usable = [](double number) { return number > 0.0 && std::isfinite(number); };
  if (!is_usable(one.value) || !is_usable(one.estimate)) {
    throw core::InvalidInput{
        fmt::format("values and estimates of magnitude are finite and above 0, not {} and {}",
                    one.value, one.estimate)};
  }
}

Means log_means(const Estimates& estimates) {
  std::map<double, std::vector<double>> by_value;
  for (const MagnitudeEstimate& one : estimates) {
    check(one);
    by_value[std::log10(one.value)].push_back(std::log10(one.estimate));
  }
  if (by_value.size() < 2) {
    throw core::NotEstimable{fmt::format(
        "an exponent takes estimates of two values or more from each participant, not {}",
        by_value.size())};
  }
  Means means;
  for (const auto& [x, y] : by_value) {
    means[x] = mean_and_spread(y).mean;
  }
  return means;
}

void check_same_values(const Means& first, const Means& other) {
  if (!std::ranges::equal(first, other, {}, &Means::value_type::first, &Means::value_type::first)) {
    throw core::NotEstimable{"an exponent takes participants who all judged the same values"};
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
  return {slope, mean_y - slope * mean_x, yy > 0.0 ? std::optional{xy * slope / yy} : std::nullopt};
}

// Each value's log10 estimates by all participants, shifted to the participants' common mean.
std::map<double, std::vector<double>> equalised(const std::vector<Means>& participants) {
  double common = 0.0;
  for (const Means& means : participants) {
    common += mean_of(means) / static_cast<double>(participants.size());
  }
  std::map<double, std::vector<double>> by_value;
  for (const Means& means : participants) {
    const double shift = common - mean_of(means);
    for (const auto& [x, y] : means) {
      by_value[x].push_back(y + shift);
    }
  }
  return by_value;
}
}  // namespace

PowerLaw power_law(const std::vector<Estimates>& participants) {
  if (participants.empty()) {
    throw core::NotEstimable{"nobody judged all values"};
  }
  PowerLaw law;
  std::vector<Means> means;
  for (const Estimates& estimates : participants) {
    means.push_back(log_means(estimates));
    check_same_values(means.front(), means.back());
    law.participant_exponents.push_back(regression(means.back()).slope);
  }
  Means all;
  for (const auto& [x, y] : equalised(means)) {
    const MeanAndSpread spread = mean_and_spread(y);
    all[x] = spread.mean;
    law.means.push_back(
        {std::pow(10.0, x), std::pow(10.0, spread.mean), spread.standard_deviation});
  }
  const Line line = regression(all);
  law.exponent = line.slope;
  law.log_constant = line.intercept;
  law.r_squared = line.r_squared;
  if (participants.size() > 1) {
    law.exponent_interval = t_interval(law.participant_exponents);
  }
  return law;
}
}  // namespace tapstudy::analysis
