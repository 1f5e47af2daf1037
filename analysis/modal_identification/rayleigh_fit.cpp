#include "analysis/modal_identification/rayleigh_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/statistics/distributions.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double min_frequency_difference = 1e-6;

struct Weighted {
  Eigen::MatrixX2d share;  // of alpha and beta, over standard errors
  Eigen::VectorXd ratio;   // likewise
};

Weighted weighted(const std::vector<MeasuredRatio>& measured) {
  const auto count = static_cast<Eigen::Index>(measured.size());
  Weighted system{Eigen::MatrixX2d{count, 2}, Eigen::VectorXd{count}};
  for (Eigen::Index i = 0; i < count; ++i) {
    const MeasuredRatio& one = measured[static_cast<std::size_t>(i)];
    if (!(one.standard_error > 0.0)) {
      throw core::InvalidInput{"a damping ratio's standard error must be above 0"};
    }
    const double omega = 2.0 * std::numbers::pi * one.frequency_hz;
    system.share.row(i) << 0.5 / omega / one.standard_error, 0.5 * omega / one.standard_error;
    system.ratio[i] = one.ratio / one.standard_error;
  }
  return system;
}

struct Coefficients {
  Eigen::Vector2d value{Eigen::Vector2d::Zero()};
  Eigen::Vector2d variance{Eigen::Vector2d::Zero()};
  double chi_squared{};
  int free{};
};

Coefficients both_free(const Weighted& system) {
  const Eigen::Vector2d size = system.share.colwise().norm().transpose();
  const Eigen::MatrixX2d scaled = system.share * size.cwiseInverse().asDiagonal();
  const Eigen::Matrix2d inverse = (scaled.transpose() * scaled).inverse();
  const Eigen::Vector2d solution = inverse * (scaled.transpose() * system.ratio);
  return {solution.cwiseQuotient(size), inverse.diagonal().cwiseQuotient(size.cwiseAbs2()),
          (system.ratio - scaled * solution).squaredNorm(), 2};
}

Coefficients one_free(const Weighted& system, Eigen::Index which) {
  const Eigen::VectorXd share = system.share.col(which);
  Coefficients result;
  result.value[which] = std::max(0.0, share.dot(system.ratio) / share.squaredNorm());
  result.variance[which] = 1.0 / share.squaredNorm();
  result.chi_squared = (system.ratio - share * result.value[which]).squaredNorm();
  result.free = 1;
  return result;
}

Coefficients not_negative(const Weighted& system) {
  const Coefficients both = both_free(system);
  if (both.value.minCoeff() >= 0.0) {
    return both;
  }
  const Coefficients alpha = one_free(system, 0);
  const Coefficients beta = one_free(system, 1);
  return alpha.chi_squared < beta.chi_squared ? alpha : beta;
}
}  // namespace

std::optional<RayleighFit> fit_rayleigh(const std::vector<MeasuredRatio>& measured) {
  const auto [lowest, highest] =
      std::ranges::minmax_element(measured, {}, &MeasuredRatio::frequency_hz);
  if (measured.size() < 2 || highest->frequency_hz - lowest->frequency_hz <
                                 min_frequency_difference * highest->frequency_hz) {
    return std::nullopt;
  }
  const Coefficients found = not_negative(weighted(measured));
  RayleighFit fit;
  fit.is_bounded = found.free < 2;
  fit.chi_squared = found.chi_squared;
  fit.degrees_of_freedom = static_cast<double>(measured.size()) - found.free;
  double factor = normal_quantile(0.975);
  double scale = 1.0;
  if (fit.degrees_of_freedom > 0.0) {
    fit.p = chi_squared_p(fit.chi_squared, fit.degrees_of_freedom);
    if (fit.chi_squared > fit.degrees_of_freedom) {
      scale = std::sqrt(fit.chi_squared / fit.degrees_of_freedom);
      factor = t_quantile(0.975, fit.degrees_of_freedom);
    }
  }
  const auto estimate = [&](Eigen::Index i) {
    const double error = scale * std::sqrt(found.variance[i]);
    return Estimate{
        found.value[i],
        error,
        {std::max(0.0, found.value[i] - factor * error), found.value[i] + factor * error},
        std::nullopt};
  };
  fit.alpha_per_s = estimate(0);
  fit.beta_s = estimate(1);
  for (const MeasuredRatio& one : measured) {
    const double omega = 2.0 * std::numbers::pi * one.frequency_hz;
    fit.fitted_ratios.push_back(0.5 * (found.value[0] / omega + found.value[1] * omega));
    const double misfit = std::abs(fit.fitted_ratios.back() / one.ratio - 1.0);
    if (misfit >= fit.largest_misfit) {
      fit.largest_misfit = misfit;
      fit.at_hz = one.frequency_hz;
    }
  }
  return fit;
}
}  // namespace tapstudy::analysis
