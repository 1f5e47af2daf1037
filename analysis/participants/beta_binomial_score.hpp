#pragma once
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// Of a beta-binomial distribution: mean in (0, 1), nu = 1 / intra-class correlation - 1, above 0.
struct BetaBinomialParameters {
  double mean{};
  double nu{};
};
// The maximum of the likelihood near a place where values can tell no better: Newton's method on
// the score. The place itself if that leads away.
BetaBinomialParameters refined(const std::vector<Proportion>& people,
                               const BetaBinomialParameters& near);
}  // namespace tapstudy::analysis
