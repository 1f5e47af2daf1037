#pragma once
#include <optional>
#include <vector>

#include "analysis/statistics/confusion_matrix.hpp"
#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// Sensitivity and criterion from two rates: "yes" to signals (hits) and to noise (false alarms), or
// "different" to different and to same pairs. Every function throws InvalidInput for counts that
// are not possible (0 <= k <= n, n > 0) and rates outside (0, 1).

// The log-linear correction of a rate (Hautus 1995): (k + 1/2) / (n + 1), never 0 or 1.
double log_linear_rate(const Proportion& answers);

struct YesNoSensitivity {
  double d_prime{};             // z(H) - z(F); negative if there are more false alarms than hits
  Interval d_prime_interval;    // 95 %
  double criterion{};           // c = -(z(H) + z(F)) / 2: above 0, "no" is preferred
  Interval criterion_interval;  // 95 %
  bool is_below_chance{};       // fewer hits than false alarms
};
// Yes/no by rates corrected as above; intervals by the variance of z (Gourevitch & Galanter 1967),
// var z = p (1 - p) / (n phi(z)^2), at the corrected rates with n + 1 trials.
YesNoSensitivity yes_no_sensitivity(const Proportion& hits, const Proportion& false_alarms);

// The hit rate of a differencing observer in same/different, who says "different" where two
// observations differ by more than k (Macmillan & Creelman 2005, ch. 9): F = 2 Phi(-k / sqrt 2), H
// = Phi((d' - k) / sqrt 2) + Phi((-d' - k) / sqrt 2).
double same_different_hit_rate(double d_prime, double false_alarm_rate);

struct RatesSensitivity {
  double d_prime{};        // >= 0
  bool is_below_chance{};  // no more hits than false alarms: d' is given as 0
};
// The inverse of same_different_hit_rate.
RatesSensitivity same_different_differencing(double hit_rate, double false_alarm_rate);
// d' in same/different by independent observations: the unbiased proportion Phi((z(H) - z(F)) / 2)
// through the decision model of that name.
RatesSensitivity same_different_independent(double hit_rate, double false_alarm_rate);

// 95 % intervals of the two, of rates corrected as above. By independent observations d' follows
// from z(H) - z(F) alone, so that yes_no_sensitivity's interval is mapped; of differencing by the
// same variances and the slopes of d' along z(H) and z(F). From 0; unset where d' is 0 or infinite.
std::optional<Interval> same_different_independent_interval(const Proportion& hits,
                                                            const Proportion& false_alarms);
std::optional<Interval> same_different_differencing_interval(const Proportion& hits,
                                                             const Proportion& false_alarms);

// Each class of a square confusion matrix told from all others, as yes/no with rates corrected by
// Hautus 1995: hits are its trials answered with it, false alarms other trials answered with it.
// d' and the criterion c of each class, unset for a class that was never presented or that alone
// was. Throws InvalidInput as totals_of_square does.
std::vector<std::optional<YesNoSensitivity>> one_against_rest(const CountTable& table);
}  // namespace tapstudy::analysis
