#pragma once
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

// The share of right answers over participants who differ, of whom those at hand are a sample.
// Answers of one participant are not independent of one another, so that the score interval of all
// answers pooled is too short.
struct BetaBinomialMean {
  int participants{};               // with answers
  double mean{};                    // of the distribution, by maximum likelihood
  double intraclass_correlation{};  // of the same; 0: participants do not differ
  Interval interval;                // 95 %, profile likelihood, see below
};
// k_i right of n_i are beta-binomial with one mean and one intra-class correlation (Williams 1975).
// The interval holds the means whose profile likelihood is 2 (l_max - l(mean)) <= t^2, with t the
// 97.5 % quantile of Student's t with participants - 1 degrees of freedom in place of the normal
// one: that keeps its coverage with few participants. Throws InvalidInput for counts that are not
// possible; unset for fewer than two participants with answers.
std::optional<BetaBinomialMean> beta_binomial_mean(const std::vector<Proportion>& participants);

// The same with the mean of the participants' shares.
struct MeanProportion : BetaBinomialMean {
  double mean_of_shares{};
  std::optional<Interval> t;          // 95 %, of that mean; unset if all shares are equal
  std::optional<Interval> bootstrap;  // 95 %, of that mean, by bootstrap_interval; unset likewise
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
// bca_interval.
std::optional<Interval> bootstrap_interval(const std::vector<double>& values, int draws,
                                           std::uint64_t seed);

// mean +- t s / sqrt n, 95 %. Throws InvalidInput for fewer than two finite values.
Interval t_interval(const std::vector<double>& values);

// A difference between two conditions, one value a participant (NaN and infinity are refused).
struct PairedContrast {
  double mean{};
  std::optional<Interval> interval;  // 95 %, by t; unset for one participant or equal differences
  double p{};                        // two-sided, by sign_flip_p
  int participants{};
  bool is_exact{};  // p is of all sign patterns
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
