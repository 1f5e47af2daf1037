#include "analysis/statistics/detection/rates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/statistics/detection/decision_model.hpp"
#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/numerics.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using std::numbers::sqrt2;

void check_rate(double rate) {
  if (!(rate > 0.0 && rate < 1.0)) {
    throw core::InvalidInput{fmt::format("a rate is between 0 and 1 and neither, not {}", rate)};
  }
}

double z_variance(const Proportion& answers) {
  const double rate = log_linear_rate(answers);
  const double density = normal_density(normal_quantile(rate));
  return rate * (1.0 - rate) / (static_cast<double>(answers.trials + 1) * density * density);
}

Interval around(double centre, double standard_error) {
  const double half_width = normal_quantile(0.975) * standard_error;
  return {centre - half_width, centre + half_width};
}

}  // namespace

double log_linear_rate(const Proportion& answers) {
  if (answers.trials <= 0 || answers.successes < 0 || answers.successes > answers.trials) {
    throw core::InvalidInput{
        fmt::format("{} answers in {} trials are not possible", answers.successes, answers.trials)};
  }
  return (static_cast<double>(answers.successes) + 0.5) /
         (static_cast<double>(answers.trials) + 1.0);
}

YesNoSensitivity yes_no_sensitivity(const Proportion& hits, const Proportion& false_alarms) {
  const double hit_z = normal_quantile(log_linear_rate(hits));
  const double false_alarm_z = normal_quantile(log_linear_rate(false_alarms));
  const double spread = std::sqrt(z_variance(hits) + z_variance(false_alarms));
  YesNoSensitivity result;
  result.d_prime = hit_z - false_alarm_z;
  result.d_prime_interval = around(result.d_prime, spread);
  const double sum = hit_z + false_alarm_z;
  const double rounding = 1e-14 * (std::abs(hit_z) + std::abs(false_alarm_z));
  result.criterion = std::abs(sum) <= rounding ? 0.0 : -0.5 * sum;
  result.criterion_interval = around(result.criterion, 0.5 * spread);
  result.is_below_chance = result.d_prime < 0.0;
  return result;
}

double same_different_hit_rate(double d_prime, double false_alarm_rate) {
  check_rate(false_alarm_rate);
  if (!(d_prime >= 0.0)) {
    throw core::InvalidInput{fmt::format("d' is at least 0, not {}", d_prime)};
  }
  const double limit = normal_quantile(0.5 * false_alarm_rate);  // -k / sqrt 2
  return normal_cdf(limit + d_prime / sqrt2) + normal_cdf(limit - d_prime / sqrt2);
}

RatesSensitivity same_different_differencing(double hit_rate, double false_alarm_rate) {
  check_rate(hit_rate);
  check_rate(false_alarm_rate);
  if (hit_rate <= false_alarm_rate) {
    return {0.0, true};
  }
  const auto excess = [&](double d_prime) {
    return same_different_hit_rate(d_prime, false_alarm_rate) - hit_rate;
  };
  if (excess(max_d_prime) <= 0.0) {
    return {std::numeric_limits<double>::infinity(), false};
  }
  return {root(excess, 0.0, max_d_prime), false};
}

namespace {
double independent_d_prime(double z_difference) {
  return d_prime_of({DecisionModel::same_different_independent_observation, 2},
                    normal_cdf(0.5 * z_difference));
}
}  // namespace

RatesSensitivity same_different_independent(double hit_rate, double false_alarm_rate) {
  check_rate(hit_rate);
  check_rate(false_alarm_rate);
  return {independent_d_prime(normal_quantile(hit_rate) - normal_quantile(false_alarm_rate)),
          hit_rate <= false_alarm_rate};
}

std::optional<Interval> same_different_independent_interval(const Proportion& hits,
                                                            const Proportion& false_alarms) {
  const YesNoSensitivity of = yes_no_sensitivity(hits, false_alarms);
  if (of.d_prime <= 0.0) {
    return std::nullopt;
  }
  return Interval{independent_d_prime(of.d_prime_interval.low),
                  independent_d_prime(of.d_prime_interval.high)};
}

std::optional<Interval> same_different_differencing_interval(const Proportion& hits,
                                                             const Proportion& false_alarms) {
  constexpr double step = 1e-3;  // of z
  const double hit_z = normal_quantile(log_linear_rate(hits));
  const double false_alarm_z = normal_quantile(log_linear_rate(false_alarms));
  const auto d_prime = [](double of_hits, double of_false_alarms) {
    return same_different_differencing(normal_cdf(of_hits), normal_cdf(of_false_alarms)).d_prime;
  };
  const double centre = d_prime(hit_z, false_alarm_z);
  const double slope_hits =
      (d_prime(hit_z + step, false_alarm_z) - d_prime(hit_z - step, false_alarm_z)) / (2.0 * step);
  const double slope_false_alarms =
      (d_prime(hit_z, false_alarm_z + step) - d_prime(hit_z, false_alarm_z - step)) / (2.0 * step);
  const Interval range =
      around(centre, std::sqrt(slope_hits * slope_hits * z_variance(hits) +
                               slope_false_alarms * slope_false_alarms * z_variance(false_alarms)));
  if (!(centre > 0.0) || !std::isfinite(range.high)) {
    return std::nullopt;
  }
  return Interval{std::max(range.low, 0.0), range.high};
}

std::vector<std::optional<YesNoSensitivity>> one_against_rest(const CountTable& table) {
  const TableTotals totals = totals_of_square(table);
  std::vector<std::optional<YesNoSensitivity>> found;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::int64_t others = totals.all - totals.rows[i];
    if (totals.rows[i] == 0 || others == 0) {
      found.emplace_back();
      continue;
    }
    found.emplace_back(yes_no_sensitivity({table[i][i], totals.rows[i]},
                                          {totals.columns[i] - table[i][i], others}));
  }
  return found;
}
}  // namespace tapstudy::analysis
