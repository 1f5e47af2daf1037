#pragma once
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// One estimate of the magnitude of a stimulus with this value; both above 0.
struct MagnitudeEstimate {
  double value{};
  double estimate{};
};
using Estimates = std::vector<MagnitudeEstimate>;  // one participant's

struct PowerLaw {
  double exponent{};      // of the geometric means
  double log_constant{};  // log10 estimate = log_constant + exponent log10 value
  double r_squared{};
  std::vector<MagnitudeEstimate> geometric_means;  // by value, after modulus equalisation
  std::vector<double> participant_exponents;
  Interval exponent_interval;  // 95 %, by t over the participants' exponents, around their mean
};
// Stevens' power law (Stevens 1957) by least squares of log10 geometric mean on log10 value. Before
// that each participant's estimates are multiplied so that the mean of their logarithms is that of
// all participants (modulus equalisation; Lane, Catania & Stevens 1961). Each participant's
// repeated estimates of a value count as their geometric mean. The exponent is then the mean of the
// participants' exponents. Throws InvalidInput for numbers that are not above 0 and finite, fewer
// than two participants or values, and participants who did not all judge the same values (their
// mean would then say which values they judged, not only their modulus).
PowerLaw power_law(const std::vector<Estimates>& participants);
}  // namespace tapstudy::analysis
