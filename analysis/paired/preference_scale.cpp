#include "analysis/paired/preference_scale.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "analysis/statistics/distributions.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
Interval interval_of(double value, double standard_error) {
  const double half_width = normal_quantile(0.975) * standard_error;
  return {value - half_width, value + half_width};
}

// 1/m among the items' values: the projection on what differences do not determine.
Eigen::MatrixXd undetermined(Eigen::Index items, Eigen::Index parameters) {
  Eigen::MatrixXd projection = Eigen::MatrixXd::Zero(parameters, parameters);
  projection.topLeftCorner(items, items).setConstant(1.0 / static_cast<double>(items));
  return projection;
}
}  // namespace

ScaleDifference difference(const PreferenceScale& scale, Eigen::Index i, Eigen::Index j) {
  const Eigen::Index items = scale.values.size();
  if (i < 0 || j < 0 || i >= items || j >= items || i == j) {
    throw core::InvalidInput{
        fmt::format("a difference is between two of {} items, not {} and {}", items, i, j)};
  }
  ScaleDifference result;
  result.value = scale.values[i] - scale.values[j];
  result.standard_error =
      std::sqrt(scale.covariance(i, i) + scale.covariance(j, j) - 2.0 * scale.covariance(i, j));
  result.interval = interval_of(result.value, result.standard_error);
  result.p = normal_two_sided_p(result.value / result.standard_error);
  return result;
}

ScaleMaximum maximise_scale(const ScaleLikelihood& likelihood, Eigen::Index items,
                            Eigen::Index parameters) {
  constexpr int max_iterations = 200;
  constexpr double smallest_step = 1e-10;
  const Eigen::MatrixXd projection = undetermined(items, parameters);
  Eigen::VectorXd at = Eigen::VectorXd::Zero(parameters);
  LikelihoodAt here = likelihood(at);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const Eigen::MatrixXd determined = here.information + projection;
    Eigen::VectorXd step = determined.ldlt().solve(here.score);
    LikelihoodAt there = likelihood(at + step);
    while (!(there.value >= here.value) && step.cwiseAbs().maxCoeff() > smallest_step) {
      step *= 0.5;
      there = likelihood(at + step);
    }
    at += step;
    here = there;
    if (step.cwiseAbs().maxCoeff() <= smallest_step) {
      break;
    }
  }
  at.head(items).array() -= at.head(items).mean();
  const Eigen::MatrixXd determined = here.information + projection;
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(parameters, parameters);
  return {at, determined.ldlt().solve(identity) - projection, here.value};
}

PreferenceScale scale_of(const ScaleMaximum& maximum, Eigen::Index items) {
  PreferenceScale scale{maximum.at.head(items),
                        maximum.covariance.topLeftCorner(items, items),
                        {},
                        maximum.log_likelihood};
  for (Eigen::Index i = 0; i < items; ++i) {
    scale.intervals.push_back(interval_of(scale.values[i], std::sqrt(scale.covariance(i, i))));
  }
  return scale;
}
}  // namespace tapstudy::analysis
