#pragma once
#include <optional>
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// Two measurements of each person: how far the second is from the first. Differences are taken for
// normal.
struct LimitsOfAgreement {
  double mean{};                          // of second less first
  std::optional<Interval> mean_interval;  // 95 %, by t; unset if all differences are equal
  // mean -+ 1.96 standard deviations, between which 95 % of people's differences lie (Bland &
  // Altman 1986).
  Interval limits;
  // 95 %, of each limit, by the non-central t distribution (Carkeet 2015); unset likewise.
  std::optional<Interval> low_interval;
  std::optional<Interval> high_interval;
};
// Throws InvalidInput for fewer than two people, as many firsts as seconds, and values that are not
// finite.
LimitsOfAgreement limits_of_agreement(const std::vector<double>& first,
                                      const std::vector<double>& second);

// The share of the variance of single measurements that lies between people, in absolute terms: a
// constant shift from one occasion to the next lowers it. ICC(A,1) of people and occasions that are
// samples (McGraw & Wong 1996), from the mean squares R of n people, C of k occasions and E of what
// is left:
//   (R - E) / (R + (k - 1) E + k / n (C - E)).
// It is below 0 where people differ less than their own measurements do.
struct IntraclassCorrelation {
  double value{};
  Interval interval;  // 95 %, by F with Satterthwaite's degrees of freedom (of the same)
};
// occasions: each with the values of the same people. Throws InvalidInput for fewer than two
// occasions or people, unequal numbers, and values that are not finite; unset where people do not
// differ, and where nothing is left over, so that there is no interval.
std::optional<IntraclassCorrelation> intraclass_correlation(
    const std::vector<std::vector<double>>& occasions);
// Whether people's means over the occasions differ, by more than rounding. Throws likewise.
bool do_people_differ(const std::vector<std::vector<double>>& occasions);
}  // namespace tapstudy::analysis
