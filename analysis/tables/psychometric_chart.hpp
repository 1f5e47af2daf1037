#pragma once
#include "analysis/psychometric/fit.hpp"
#include "analysis/tables/chart.hpp"
namespace tapstudy::analysis {
// A mark for each level, its area by the level's share of the most trials at one.
std::vector<ChartPoint> level_points(const std::vector<Level>& levels);
// psi across the chart's range of x, as far as the shape allows.
std::vector<ChartPoint> curve_points(const Chart& chart, core::PsychometricShape shape,
                                     const PsychometricCurve& curve);
}  // namespace tapstudy::analysis
