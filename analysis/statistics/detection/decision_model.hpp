#pragma once
#include <span>
#include <string_view>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// Sensitivity d' from proportions of correct answers, by each task's decision model for unbiased
// observers with equal-variance Gaussian observations (Green & Swets 1966; Macmillan & Creelman
// 2005, ch. 7 and 9). d' is in standard deviations of one observation.
enum class DecisionModel {
  forced_choice,                // m-AFC: which of m is the one? (Hacker & Ratcliff 1979; Green &
                                // Dai 1991): the greatest observation
  oddity,                       // which of m is the odd one? 3 (triangle; Frijters 1979) or 4:
                                // that furthest from the mean of all (Versfeld et al. 1996)
  abx_differencing,             // is X A or B? the nearer of the two (ABX and matching to sample
  abx_independent_observation,  // of two, Hautus & Meng 2002), or the likelier
  same_different_independent_observation  // which of the four pairs was it? the likelier answer
};

// The largest d' that is looked for: what lies beyond cannot be told from certainty.
inline constexpr double max_d_prime = 20.0;

struct DecisionModelRow {
  DecisionModel model{};
  std::string_view name;
  int fewest_alternatives{};  // answers: chance is 1 in so many
  int most_alternatives{};
  double (*proportion_correct)(double d_prime, int alternatives);
  std::string_view summary;
};
// All models, in the order of DecisionModel.
std::span<const DecisionModelRow> decision_models();
// nullptr if there is none of that name.
const DecisionModelRow* find_decision_model(std::string_view name);

// A model with its number of alternatives.
struct DecisionTask {
  DecisionModel model{};
  int alternatives{2};
};

// The functions below throw InvalidInput for a number of alternatives that the model does not have.
double chance(const DecisionTask& task);
// Pc(d'), d' >= 0 and finite; else throws InvalidInput. Increases from chance to 1.
double proportion_correct(const DecisionTask& task, double d_prime);
// The inverse of Pc(d'): 0 for proportions up to chance, infinity for 1 (from d' = 20 on Pc is 1 to
// the last digit). proportion in [0, 1], else throws InvalidInput.
double d_prime_of(const DecisionTask& task, double proportion);

struct Sensitivity {
  double d_prime{};        // >= 0
  Interval interval;       // 95 %; high may be infinity
  bool is_below_chance{};  // fewer right than chance: d' is given as 0
  bool is_perfect{};       // all right: d' is that of 1/2 wrong answer (Macmillan & Kaplan 1985)
};
// d' of k right answers in n, with the score interval of the proportion (Wilson 1927) mapped
// through d'. Throws InvalidInput unless 0 <= k <= n and n > 0.
Sensitivity sensitivity(const DecisionTask& task, const Proportion& correct);
}  // namespace tapstudy::analysis
