#pragma once
#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// The logarithm of the probability of k successes in n without the binomial coefficient, where the
// proportion itself varies from level to level by a beta distribution of mean p (Schütt et al.
// 2016, eq. 4 to 6): with nu = 1 / eta^2 - 1, B(k + nu p, n - k + nu (1 - p)) / B(nu p, nu (1 -
// p)). eta in [0, 1): 0 is binomial; the variance of the proportion is eta^2 p (1 - p).
double beta_binomial_log_likelihood(const Proportion& answers, double p, double eta);
}  // namespace tapstudy::analysis
