#pragma once
#include <limits>
#include <optional>
#include <vector>

#include "analysis/modal/decay/estimate.hpp"
#include "core/model/elements/material.hpp"
namespace tapstudy::analysis {
struct MeasuredRatio {
  double frequency_hz{};
  double ratio{};
  double standard_error{};  // above 0
  // Degrees of freedom of the standard error: below 30 it is an estimate over taps.
  double degrees_of_freedom{std::numeric_limits<double>::infinity()};
};

struct RayleighFit {
  Estimate alpha_per_s;
  Estimate beta_s;
  std::vector<double> fitted_ratios;  // in the order given
  double chi_squared{};               // of the misfits over their standard errors
  double degrees_of_freedom{};        // 0 of two modes: nothing says whether Rayleigh damping fits
  std::optional<double> p;            // unset likewise
  bool p_is_of_f{};                   // not of chi-squared: the errors are estimates themselves
  double largest_misfit{};            // |fitted / measured - 1|
  double at_hz{};
  bool is_bounded{};  // a coefficient would have been negative, and was held at 0
  // Ratios are as measurements allow, or within 10 % everywhere, below what makes a difference.
  bool fits() const { return !p || *p > 0.05 || largest_misfit < 0.1; }
};

// Rayleigh's coefficients by weighted least squares of the paper's eq. 12, zeta = (alpha / omega +
// beta omega) / 2, weights 1 / standard error squared, neither below 0. Errors over few taps are
// moderated by the relative scatter of all modes (as a prior of four degrees of freedom; Smyth
// 2004). 95 % intervals: Student's t (Welch 1947); where chi-squared exceeds its degrees of
// freedom, with errors larger by the root of their ratio (Birge 1932). Unset for fewer than two
// different frequencies. Throws InvalidInput for a standard error that is not above 0.
std::optional<RayleighFit> fit_rayleigh(const std::vector<MeasuredRatio>& measured);
}  // namespace tapstudy::analysis
