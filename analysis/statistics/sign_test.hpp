#pragma once
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// The exact sign test of "above 0 more often than below": differences of 0 are left out, the others
// are above 0 with a probability of 1/2 (Dixon & Mood 1946).
struct SignTest {
  Proportion above;  // of differences that are not 0
  double p{};        // one-sided; 1 if none is left
};
SignTest sign_test(const std::vector<double>& differences);
}  // namespace tapstudy::analysis
