#pragma once
#include <cstdint>
#include <optional>
#include <vector>
namespace tapstudy::analysis {
struct Interval {
  double low{};
  double high{};
};

// k successes in n trials.
struct Proportion {
  std::int64_t successes{};
  std::int64_t trials{};
  double value() const {  // trials > 0
    return static_cast<double>(successes) / static_cast<double>(trials);
  }
  void add(bool is_success) {
    ++trials;
    successes += is_success ? 1 : 0;
  }
};

Proportion sum(const std::vector<Proportion>& parts);

// The 95 % score interval of a proportion (Wilson 1927). trials > 0.
Interval wilson_interval(const Proportion& proportion);

// The exact 95 % interval (Clopper & Pearson 1934): it holds at least as often. trials > 0.
Interval exact_interval(const Proportion& proportion);

// P(X >= k) for X binomial(n, chance): the exact one-sided test of "more often than chance".
double binomial_p_at_least(const Proportion& observed, double chance);

// The exact multinomial test of equal probabilities: p sums the outcomes no more probable than the
// one observed. Every outcome is enumerated; nullopt if there are more than a million.
// counts not empty, none negative.
std::optional<double> exact_multinomial_p(const std::vector<int>& counts);

// The smallest number of successes in n trials that is significant at alpha against chance,
// one-sided; n + 1 if there is none.
int critical_successes(int trials, double chance, double alpha);
// The probability of reaching critical_successes when the true proportion is `truth`.
double binomial_power(int trials, double chance, double alpha, double truth);

// 95 % intervals of the probabilities of all classes at once (Goodman 1965): with A the 1 - .05 / k
// quantile of chi-squared of one degree of freedom, (A + 2 n_i -+ sqrt(A (A + 4 n_i (N - n_i) /
// N))) / (2 (N + A)). counts of independent choices. Throws InvalidInput for fewer than two
// classes, counts below 0, and no counts above 0.
std::vector<Interval> simultaneous_intervals(const std::vector<int>& counts);

struct IntervalEstimate {
  double value{};
  Interval interval;  // 95 %
  // Of the quantile of t that the interval is by; unset: the normal distribution's.
  std::optional<double> degrees_of_freedom{};
};
// The difference b - a of estimates of independent samples: its variance is recovered from the
// distances to the interval ends on the relevant side, each over its own quantile (MOVER; Zou &
// Donner 2008), and the quantile of the difference has the degrees of freedom of that sum of
// variances (Welch 1947). For score intervals of proportions it is Newcombe's (1998) method 10, for
// means by t Welch's interval.
IntervalEstimate independent_difference(const IntervalEstimate& a, const IntervalEstimate& b);
// The ratio b / a of two estimates above 0, by the difference of their logarithms.
IntervalEstimate independent_ratio(const IntervalEstimate& a, const IntervalEstimate& b);
}  // namespace tapstudy::analysis
