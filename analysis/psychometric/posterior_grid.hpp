#pragma once
#include <array>
#include <vector>

#include "analysis/psychometric/fit.hpp"
namespace tapstudy::analysis {
// The places of a posterior's parameters: the threshold's position on the shape's axis, ln width,
// guess rate, lapse rate, eta.
enum PosteriorPlace : std::size_t {
  position_at,
  log_width_at,
  guess_rate_at,
  lapse_rate_at,
  eta_at
};
constexpr std::size_t posterior_parameters = 5;

// Cells of equal width from low to high; one cell if the parameter is fixed (low = high).
struct GridAxis {
  double low{};
  double high{};
  std::size_t cells{1};
  double cell() const { return (high - low) / static_cast<double>(cells); }
  double centre(std::size_t i) const { return low + (static_cast<double>(i) + 0.5) * cell(); }
};
using PosteriorAxes = std::array<GridAxis, posterior_parameters>;
// The probability of each cell of each axis.
using Marginals = std::array<std::vector<double>, posterior_parameters>;

// ln of the prior's density, up to a constant; -infinity where there is none.
double log_prior_of_position(double position, const AxisRange& range);
double log_prior_of_width(double width, const AxisRange& range);
double log_prior_of_rate(double rate);

// The distance on the axis from F = 0.05 to F = 0.95 at a slope of 1.
double width_of_unit_slope(core::PsychometricShape shape);

// Where the prior is not 0, coarse: free parameters with half the cells of a result.
PosteriorAxes prior_axes(const PsychometricModel& model, const std::vector<Level>& levels);
Marginals marginals_on(const PosteriorAxes& axes, const PsychometricModel& model,
                       const std::vector<Level>& levels);
}  // namespace tapstudy::analysis
