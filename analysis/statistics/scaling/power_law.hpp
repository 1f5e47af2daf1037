#pragma once
#include <optional>
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// One estimate of the magnitude of a stimulus with this value; both above 0.
struct MagnitudeEstimate {
  double value{};
  double estimate{};
};
using Estimates = std::vector<MagnitudeEstimate>;  // one participant's

// The mean of all participants' estimates of one value.
struct MagnitudeMean {
  double value{};
  double geometric_mean{};
  double log_standard_deviation{};  // of log10 estimates after modulus equalisation
};

struct PowerLaw {
  double exponent{};                  // of the geometric means
  double log_constant{};              // log10 estimate = log_constant + exponent log10 value
  std::optional<double> r_squared{};  // unset where all means are equal
  std::vector<MagnitudeMean> means;   // by value
  std::vector<double> participant_exponents;
  // 95 %, by t over the participants' exponents, around their mean; unset for one participant
  std::optional<Interval> exponent_interval{};
};
// Stevens' power law (Stevens 1957) by least squares of log10 geometric mean on log10 value. Each
// participant's repeated estimates of a value count as their geometric mean. For the spread of
// estimates each participant's are multiplied so that the mean of their logarithms is that of all
// participants (modulus equalisation; Lane, Catania & Stevens 1961); where all judge the same
// values, which is asked for, that leaves the geometric means as they are, and the exponent is the
// mean of the participants' exponents. Throws InvalidInput for numbers that are not above 0 and
// finite, no participants, fewer than two values, and participants with different values.
PowerLaw power_law(const std::vector<Estimates>& participants);
}  // namespace tapstudy::analysis
