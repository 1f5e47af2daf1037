#include "analysis/modal/decay/estimate.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::size_t min_taps_to_resample = 5;
constexpr int bootstrap_draws = 2000;
constexpr std::uint64_t bootstrap_seed = 1;
}  // namespace

Estimate t_estimate(double value, double standard_error, double degrees_of_freedom) {
  const double half = t_quantile(0.975, degrees_of_freedom) * standard_error;
  return {value, standard_error, {value - half, value + half}, std::nullopt};
}

Estimate estimate_over_taps(const std::vector<double>& values, const std::vector<double>& errors,
                            double degrees_of_freedom_of_one) {
  if (values.size() == 1) {
    return t_estimate(values.front(), errors.front(), degrees_of_freedom_of_one);
  }
  const auto count = static_cast<double>(values.size());
  const MeanAndSpread over = mean_and_spread(values);
  Estimate estimate =
      t_estimate(over.mean, over.standard_deviation / std::sqrt(count), count - 1.0);
  const double of_noise =
      Eigen::Map<const Eigen::VectorXd>(errors.data(), std::ssize(errors)).norm() / count;
  estimate.standard_error = std::max(estimate.standard_error, of_noise);
  if (values.size() >= min_taps_to_resample) {
    estimate.bootstrap = bootstrap_interval(values, bootstrap_draws, bootstrap_seed);
  }
  return estimate;
}

Estimate jackknife_estimate(double of_all, const std::vector<double>& without, double of_noise,
                            double degrees_of_freedom) {
  const Estimate by_noise = t_estimate(of_all, of_noise, degrees_of_freedom);
  if (without.size() < 2) {
    return by_noise;
  }
  const auto groups = static_cast<double>(without.size());
  const double error =
      mean_and_spread(without).standard_deviation * (groups - 1.0) / std::sqrt(groups);
  Estimate over_groups = t_estimate(of_all, error, groups - 1.0);
  over_groups.standard_error = std::max(error, of_noise);
  const bool is_wider = over_groups.interval.high > by_noise.interval.high;
  over_groups.interval = is_wider ? over_groups.interval : by_noise.interval;
  return over_groups;
}
}  // namespace tapstudy::analysis
