#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// Parameters of a beta-binomial distribution: mean in (0, 1), nu = 1 / intra-class correlation - 1,
// above 0.
struct BetaBinomialParameters {
  double mean{};
  double nu{};
};
// The maximum of the likelihood near a place where values can tell no better: Newton's method on
// the score. The place itself if that leads away.
BetaBinomialParameters refined(const std::vector<Proportion>& people,
                               const BetaBinomialParameters& near);

// The mean share of right answers over participants who differ, of whom those at hand are a sample,
// each counting the same: those who stopped early may be those who found it hard. Answers of one
// participant are not independent of one another, so that the score interval of all answers pooled
// is too short.
struct MeanShare {
  int participants{};  // with answers
  double mean{};       // of their shares
  // 95 %, by the score of the mean (Wilson 1927) with the variance that participants show (quasi-
  // likelihood, Wedderburn 1974) in place of the binomial one: the means m with
  //   (mean - m)^2 <= t^2 phi m (1 - m) / n,   phi = s^2 / (mean (1 - mean)),
  // s^2 the variance of n shares, t the 97.5 % quantile with n - 1 degrees of freedom. phi is at
  // least share_of_binomial of what independent answers give, mean(1 / trials), because shares are
  // discrete and may agree by chance; where fewer than two answers are right, or wrong, it is all
  // of that. Near an end of the scale the few who are far from the others are easily not in the
  // sample, and s^2 is too small: for means beyond .75 (or below .25) t^2 phi is there the larger
  // of itself and its weighted geometric mean with
  //   n ln(1 + t^2 / (n - 1)) phi(m),
  // phi(m) by the likeliest intra-class correlation of a beta-binomial distribution of mean m; the
  // weight grows from 0 to .6 at the end. The cut is that of a profile likelihood (see
  // censored_contrast). It lies within [0, 1]. Unset for two participants: their interval is as
  // good as [0, 1].
  std::optional<Interval> interval;
};
inline constexpr double share_of_binomial = 0.05;
// Throws InvalidInput for counts that are not possible; unset for fewer than two participants with
// answers.
std::optional<MeanShare> mean_share(const std::vector<Proportion>& participants);

// k_i right of n_i are beta-binomial with one mean and one intra-class correlation (Williams 1975),
// by maximum likelihood.
struct BetaBinomialMean {
  double mean{};                    // of the distribution
  double intraclass_correlation{};  // of the same; 0: participants do not differ
};
// Throws and unset as mean_share.
std::optional<BetaBinomialMean> beta_binomial_mean(const std::vector<Proportion>& participants);

// The mean share with what else is known of participants.
struct MeanProportion : MeanShare {
  double intraclass_correlation{};    // of their beta-binomial distribution
  std::optional<Interval> t;          // 95 %, of the mean; unset if all shares are equal
  std::optional<Interval> bootstrap;  // 95 %, of the mean, by bootstrap_interval; unset likewise
};
std::optional<MeanProportion> mean_proportion(const std::vector<Proportion>& participants);

// The interval of a mean by the bootstrap, corrected for bias and acceleration (Efron 1987; ties of
// the bias count one half), that leaves so much out at either end. Throws InvalidInput for fewer
// than two values and values that are not finite; unset if all are equal, which leaves nothing to
// draw from.
std::optional<Interval> bca_interval(const std::vector<double>& values, int draws,
                                     std::uint64_t seed, double tail);
// The 95 % interval of a mean by that bootstrap. Its tails are expanded for few values (Hesterberg
// 2015), as far as the bootstrap's own spread, too small by sqrt(1 - 1 / n), would make it shorter
// than that by t: of five values it would hold the mean in 83 % of samples. Throws and unset as
// bca_interval; unset also for fewer than eight values, between whose least and largest every drawn
// mean lies: of three it holds the mean in 77 % of samples, of five that are skewed in 87 %.
inline constexpr std::size_t fewest_to_draw_from = 8;
std::optional<Interval> bootstrap_interval(const std::vector<double>& values, int draws,
                                           std::uint64_t seed);

// mean +- t s / sqrt n, 95 %. Throws InvalidInput for fewer than two finite values.
Interval t_interval(const std::vector<double>& values);

// The 95 % interval of the mean of values that are not below 0, of which few may be much larger
// than the others (times, speeds, forces, deviations): t's lower end, but not below 0, and the
// upper end m of the score with a variance in proportion to the mean (Wedderburn 1974),
//   (mean - m)^2 = t^2 s^2 / n m / mean,
// because the large ones are easily not in the sample, which makes mean and s too small together.
// t's interval where a value is below 0. Throws InvalidInput as t_interval.
Interval positive_interval(const std::vector<double>& values);

// A difference between two conditions, one value a participant (NaN and infinity are refused).
struct PairedContrast {
  double mean{};
  std::optional<Interval> interval;  // 95 %, by t; unset for one participant or equal differences
  double p{};                        // two-sided, by sign_flip_p
  int participants{};
  bool is_exact{};     // p is of all sign patterns
  double direction{};  // what p is of, above or below 0: the mean, or the sum of signed ranks
  int ranges{};        // of the participants, those of whom only a range is known
};

// The permutation test of paired differences (Fisher 1935): if the conditions do not matter, each
// participant's difference might as well have had the other sign. p is the share of sign patterns
// whose sum is at least as far from 0; of all patterns for up to 16 differences that are not 0,
// else monte_carlo_p of 9999 random patterns. It is valid however participants differ. Throws
// InvalidInput for no differences, and for differences that are not finite.
struct SignFlipTest {
  double p{};
  bool is_exact{};
};
SignFlipTest sign_flip_test(const std::vector<double>& differences, std::uint64_t seed);

PairedContrast paired_contrast(const std::vector<double>& differences, std::uint64_t seed);

// Differences of which some are only known to lie in a range (low < high, either may be infinite),
// as of a threshold beyond the levels presented. Mean and interval are of a normal distribution, by
// its likelihood with probabilities of the ranges (Tobin 1958): the means whose profile likelihood
// is 2 (l_max - l(mean)) <= n ln(1 + t^2 / (n - 1)), which of exact differences is t's interval; an
// end that the likelihood does not limit is infinite. Both are NaN and unset where fewer than two
// differences are exact. p is the permutation test by signs of the differences' ranks by size, of a
// range by its least size; a range on both sides of 0 has none. Throws InvalidInput as
// sign_flip_test.
PairedContrast censored_contrast(const std::vector<Interval>& differences, std::uint64_t seed);

// That mean alone, its interval of a confidence, and its distance from values as t of n - 1 degrees
// of freedom has it: the signed root of (n - 1) (exp(2 (l_max - l(value)) / n) - 1), which of exact
// differences is t. Throws InvalidInput for no differences, NotEstimable where fewer than two are
// exact.
struct CensoredMean {
  double mean{};
  Interval interval;
  std::vector<double> t;  // from each of the values
};
CensoredMean censored_mean(const std::vector<Interval>& differences, double confidence,
                           const std::vector<double>& values = {});

// The 95 % interval of the mean of values within bounds, which it does not leave: by t with a
// variance that is in proportion to (mean - low) (high - mean), as in mean_share. Unset if all are
// equal. Throws InvalidInput for fewer than two values, and values beyond the bounds.
std::optional<Interval> bounded_interval(const std::vector<double>& values, const Interval& bounds);
}  // namespace tapstudy::analysis
