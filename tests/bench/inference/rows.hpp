#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics/proportion.hpp"
#include "core/random/rng.hpp"
namespace tapstudy::bench {
// Of people who feel nothing: answers with equal probability, one answer in 80 % of the trials, an
// answer half as often again as by chance.
enum class Guesser { indifferent, of_habit, reluctant_to_repeat };

// The p value of a test, with the probability of what is strictly further than what was observed
// where the test gives it; or 1 for an interval that holds the truth, 0 for one that does not; or
// the length of an interval, with that of t's.
struct Outcome {
  double value{};
  double of_further{std::numeric_limits<double>::quiet_NaN()};
};
inline Outcome holds(const analysis::Interval& interval, double truth) {
  return {interval.low <= truth && truth <= interval.high ? 1.0 : 0.0};
}

struct StudyDraw {
  int people{};
  core::Rng& rng;
  Guesser guesser{Guesser::indifferent};
  double intraclass_correlation{};  // of people's shares
};

enum class Kind { size, coverage, width };
// What the three numbers in a cell are of: kinds of guessers, correlations of 0, .1 and .3; or one.
enum class By { guessers, correlations, people };

// A line of the table: one statistic of one task, and a study of it; unset: the report gives none.
struct Row {
  Kind kind{};
  std::string task;
  std::string statistic;
  By by{By::people};
  std::function<std::optional<Outcome>(const StudyDraw& draw)> study;
};

std::vector<Row> rows_of_discrimination();
std::vector<Row> rows_of_identification();
std::vector<Row> rows_of_tables();
std::vector<Row> rows_of_choices();
std::vector<Row> rows_of_scales();
std::vector<Row> rows_of_shares();
std::vector<Row> rows_of_means();
std::vector<Row> rows_of_levels();
}  // namespace tapstudy::bench
