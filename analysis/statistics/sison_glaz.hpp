#pragma once
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// 95 % intervals of the probabilities of all classes at once (Sison & Glaz 1995): each share - c/N
// to + (c + 2 g)/N, within 0 and 1. c is the largest whole number for which P(|X_i - n_i| <= c for
// all i), X multinomial with the observed shares, does not exceed .95, and g interpolates to c + 1.
// That probability is a product of truncated Poisson ones times an Edgeworth series of their sum
// (Levin 1981, four moments). Between unlike shares the intervals are all of one width.
// Counts of independent choices. Throws InvalidInput for fewer than two classes, counts below 0,
// and no counts above 0.
std::vector<Interval> sison_glaz_intervals(const std::vector<int>& counts);
}  // namespace tapstudy::analysis
