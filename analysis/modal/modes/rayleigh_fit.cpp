#include "analysis/modal/modes/rayleigh_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
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

constexpr double few = 30.0;

// Two or three taps scatter by chance less than they should: such errors would outweigh others.
std::vector<MeasuredRatio> moderated(std::vector<MeasuredRatio> measured) {
  constexpr double prior_freedom = 4.0;
  double freedom = 0.0;
  double squares = 0.0;  // of the relative scatter of one tap
  for (const MeasuredRatio& one : measured) {
    if (one.degrees_of_freedom < few) {
      const double relative = one.standard_error / one.ratio;
      freedom += one.degrees_of_freedom;
      squares += one.degrees_of_freedom * (one.degrees_of_freedom + 1.0) * relative * relative;
    }
  }
  for (MeasuredRatio& one : measured) {
    if (one.degrees_of_freedom < few) {
      const double common =
          squares / freedom * one.ratio * one.ratio / (one.degrees_of_freedom + 1.0);
      const double own = one.standard_error * one.standard_error;
      one.standard_error = std::sqrt((prior_freedom * common + one.degrees_of_freedom * own) /
                                     (prior_freedom + one.degrees_of_freedom));
      one.degrees_of_freedom = std::min(prior_freedom + one.degrees_of_freedom, freedom);
    }
  }
  return measured;
}

struct Coefficients {
  Eigen::Vector2d value{Eigen::Vector2d::Zero()};
  Eigen::Vector2d unbounded{Eigen::Vector2d::Zero()};  // had it not been held at 0
  Eigen::Vector2d variance{Eigen::Vector2d::Zero()};
  Eigen::Matrix2Xd shares;  // of each ratio, over its standard error, in the coefficients
  double chi_squared{};
  int free{};
};

Coefficients both_free(const Weighted& system) {
  const Eigen::Vector2d size = system.share.colwise().norm().transpose();
  const Eigen::MatrixX2d scaled = system.share * size.cwiseInverse().asDiagonal();
  const Eigen::Matrix2d inverse = (scaled.transpose() * scaled).inverse();
  const Eigen::Vector2d solution = inverse * (scaled.transpose() * system.ratio);
  const Eigen::Vector2d value = solution.cwiseQuotient(size);
  return {value,
          value,
          inverse.diagonal().cwiseQuotient(size.cwiseAbs2()),
          size.cwiseInverse().asDiagonal() * inverse * scaled.transpose(),
          (system.ratio - scaled * solution).squaredNorm(),
          2};
}

Coefficients one_free(const Weighted& system, Eigen::Index which) {
  const Eigen::VectorXd share = system.share.col(which);
  Coefficients result;
  result.value[which] = std::max(0.0, share.dot(system.ratio) / share.squaredNorm());
  result.unbounded[which] = result.value[which];
  result.variance[which] = 1.0 / share.squaredNorm();
  result.shares = Eigen::Matrix2Xd::Zero(2, share.size());
  result.shares.row(which) = share.transpose() / share.squaredNorm();
  result.chi_squared = (system.ratio - share * result.value[which]).squaredNorm();
  result.free = 1;
  return result;
}

// Holds a coefficient at 0 with its unconstrained error: the bound does not tell how large it may
// be.
void fix_at_zero(Eigen::Index which, const Coefficients& both, Coefficients& fit) {
  fit.unbounded[which] = both.value[which];
  fit.variance[which] = both.variance[which];
  fit.shares.row(which) = both.shares.row(which);
}

Coefficients not_negative(const Weighted& system) {
  const Coefficients both = both_free(system);
  if (both.value.minCoeff() >= 0.0) {
    return both;
  }
  Coefficients alpha = one_free(system, 0);
  Coefficients beta = one_free(system, 1);
  fix_at_zero(1, both, alpha);
  fix_at_zero(0, both, beta);
  return alpha.chi_squared < beta.chi_squared ? alpha : beta;
}
// Welch 1947 and Satterthwaite 1946, of a sum of errors that have so many each.
double freedom_of(const Eigen::RowVectorXd& shares, const std::vector<MeasuredRatio>& measured) {
  double sum = 0.0;
  double weighted = 0.0;
  for (Eigen::Index i = 0; i < shares.size(); ++i) {
    const double square = shares[i] * shares[i];
    sum += square;
    weighted += square * square / measured[static_cast<std::size_t>(i)].degrees_of_freedom;
  }
  return weighted > 0.0 ? sum * sum / weighted : std::numeric_limits<double>::infinity();
}

double mean_freedom(const std::vector<MeasuredRatio>& measured) {
  double sum = 0.0;
  for (const MeasuredRatio& one : measured) {
    sum += one.degrees_of_freedom;
  }
  return sum / static_cast<double>(measured.size());
}

// known: the degrees of freedom of the errors
double misfit_p(const RayleighFit& fit, double known) {
  return known < few ? f_p(fit.chi_squared / fit.degrees_of_freedom, fit.degrees_of_freedom, known)
                     : chi_squared_p(fit.chi_squared, fit.degrees_of_freedom);
}

Estimate estimate_of(Eigen::Index i, const Coefficients& found,
                     const std::vector<MeasuredRatio>& measured, const RayleighFit& fit) {
  const bool is_misfit = fit.degrees_of_freedom > 0.0 && fit.chi_squared > fit.degrees_of_freedom;
  const double scale = is_misfit ? std::sqrt(fit.chi_squared / fit.degrees_of_freedom) : 1.0;
  double freedom = freedom_of(found.shares.row(i), measured);
  if (is_misfit && !(freedom < few)) {
    freedom = fit.degrees_of_freedom;
  }
  const double factor =
      std::isfinite(freedom) ? t_quantile(0.975, freedom) : normal_quantile(0.975);
  const double error = scale * std::sqrt(found.variance[i]);
  return {found.value[i],
          error,
          {std::max(0.0, found.unbounded[i] - factor * error),
           std::max(0.0, found.unbounded[i] + factor * error)},
          std::nullopt};
}

void add_misfits(const Coefficients& found, const std::vector<MeasuredRatio>& measured,
                 RayleighFit& fit) {
  for (const MeasuredRatio& one : measured) {
    const double omega = 2.0 * std::numbers::pi * one.frequency_hz;
    fit.fitted_ratios.push_back(0.5 * (found.value[0] / omega + found.value[1] * omega));
    const double misfit = std::abs(fit.fitted_ratios.back() / one.ratio - 1.0);
    if (misfit >= fit.largest_misfit) {
      fit.largest_misfit = misfit;
      fit.at_hz = one.frequency_hz;
    }
  }
}
}  // namespace

std::optional<RayleighFit> fit_rayleigh(const std::vector<MeasuredRatio>& as_measured) {
  const std::vector<MeasuredRatio> measured = moderated(as_measured);
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
  if (fit.degrees_of_freedom > 0.0) {
    const double known = mean_freedom(measured);
    fit.p_is_of_f = known < few;
    fit.p = misfit_p(fit, known);
  }
  fit.alpha_per_s = estimate_of(0, found, measured, fit);
  fit.beta_s = estimate_of(1, found, measured, fit);
  add_misfits(found, measured, fit);
  return fit;
}
}  // namespace tapstudy::analysis
