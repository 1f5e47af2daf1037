#pragma once
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// The mean of people who differ, each known with an error.
struct RandomEffects {
  double mean{};
  double between_sd{};  // of people, without their estimates' errors
  Interval interval;    // 95 %, of the mean: t with people - 1 degrees of freedom
};

// Weights are 1 / (error² + between²), and between² makes the weighted squares of the residuals as
// large as they are expected, people - 1; 0 if they are smaller (Paule & Mandel 1982). The interval
// is that of Hartung & Knapp 2001; where people are alike, that of their errors by t. As many
// errors as values, each above 0; two or more. Throws InvalidInput for others.
RandomEffects random_effects(const std::vector<double>& values, const std::vector<double>& errors);
}  // namespace tapstudy::analysis
