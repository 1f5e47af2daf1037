#pragma once
#include <optional>
#include <vector>

#include "analysis/statistics/psychometric/fit.hpp"
namespace tapstudy::analysis {
// The psychometric functions of several people as of one population: a generalised linear mixed
// model with a guess rate (Moscatelli et al. 2012), whose random effects are thresholds and slopes.
struct PopulationFit {
  double threshold{};        // of the population's mean on the shape's axis, in the level's unit
  Interval interval;         // an end that the answers do not tell is infinite, or 0 on a log axis
  double deviation{};        // between people, on the axis
  double log_slope{};        // mean over people of ln slope
  double slope_deviation{};  // of the same
  // Of each person, as given: mean and equal tails of the threshold, given all the above.
  struct Person {
    double threshold{};
    Interval interval;
  };
  std::vector<Person> people;
};

// Thresholds on the shape's axis and ln slopes are normal over people, independent of each other;
// the four parameters are the likeliest when each person's are integrated out on a grid, by EM
// (Bock & Aitkin 1981). Rates that are free in the model are integrated out as well: guesses
// evenly, lapses over shares of people with each rate, which are estimated with the four (beta(1,
// 10) counts as one person more: of people who lapse as often, a given distribution would take the
// lapses for shallower or steeper functions, and shift all thresholds). The interval of the mean is
// by profile likelihood, against N ln(1 + t^2 / (N - 1)) in place of the quantile of chi-squared:
// the law of the mean of N normal values, to which it comes where everybody has answered much.
// Whoever was right at all levels, or at none, takes part. nullopt: fewer than three people, fewer
// than two levels, or a mean that lies beyond the levels. Throws InvalidInput as fit_psychometric
// does.
std::optional<PopulationFit> fit_population(const PsychometricModel& model,
                                            const std::vector<std::vector<Level>>& people,
                                            double confidence = 0.95);
}  // namespace tapstudy::analysis
