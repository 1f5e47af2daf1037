#include "analysis/tables/psychometric_chart.hpp"

#include <algorithm>
#include <cmath>
namespace tapstudy::analysis {
std::vector<ChartPoint> level_points(const std::vector<Level>& levels) {
  std::int64_t most = 1;
  for (const Level& level : levels) {
    most = std::max(most, level.answers.trials);
  }
  std::vector<ChartPoint> points;
  for (const Level& level : levels) {
    points.push_back({level.value, level.answers.value(),
                      static_cast<double>(level.answers.trials) / static_cast<double>(most)});
  }
  return points;
}

std::vector<ChartPoint> curve_points(const Chart& chart, core::PsychometricShape shape,
                                     const PsychometricCurve& curve) {
  constexpr int pieces = 60;
  const auto& [low, high] = chart.x_range;
  std::vector<ChartPoint> points;
  for (int i = 0; i <= pieces; ++i) {
    const double along = static_cast<double>(i) / pieces;
    const double x =
        chart.is_x_logarithmic ? low * std::pow(high / low, along) : low + along * (high - low);
    if (x >= 0.0 || !core::row_of(shape).is_logarithmic) {
      points.push_back(
          {x, core::proportion(shape, x, curve.threshold, curve.slope, curve.guess, curve.lapse)});
    }
  }
  return points;
}
}  // namespace tapstudy::analysis
