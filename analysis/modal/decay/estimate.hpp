#pragma once
#include <optional>
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// A value with its 95 % interval.
struct Estimate {
  double value{};
  double standard_error{};            // over taps, not below what their noise alone gives
  Interval interval;                  // Student's t: over taps, or of one tap's noise
  std::optional<Interval> bootstrap;  // over taps, bias-corrected and accelerated, of 5 and more
};

// An estimate with Student's interval and no bootstrap.
Estimate t_estimate(double value, double standard_error, double degrees_of_freedom);

// For one tap, its value and standard error with these degrees of freedom; for several, the mean
// and its interval over taps. Values and errors as many, at least one.
Estimate estimate_over_taps(const std::vector<double>& values, const std::vector<double>& errors,
                            double degrees_of_freedom_of_one);

// The jackknife's error over groups of impacts (Tukey 1958), with Student's interval that is not
// narrower than what the noise alone gives: where few of the impacts tell, the jackknife's error is
// of few degrees of freedom. without: the value without each group in turn; fewer than two: noise
// alone.
Estimate jackknife_estimate(double of_all, const std::vector<double>& without, double of_noise,
                            double degrees_of_freedom_of_noise);
}  // namespace tapstudy::analysis
