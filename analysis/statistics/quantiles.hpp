#pragma once
#include <span>
#include <vector>
namespace tapstudy::analysis {
// A quantile by linear interpolation between order statistics (Hyndman & Fan 1996, type 7).
// Throws InvalidInput if there are no values, one is NaN, or the probability is outside [0, 1].
double quantile(std::vector<double> values, double probability);

struct Quartiles {
  double low{};
  double median{};
  double high{};
};
Quartiles quartiles(const std::vector<double>& values);

struct MeanAndSpread {
  double mean{};
  double standard_deviation{};  // with n - 1; NaN of one value
};
// Throws InvalidInput if there are no values.
MeanAndSpread mean_and_spread(std::span<const double> values);
}  // namespace tapstudy::analysis
