#include "analysis/statistics/population/planned_contrasts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
namespace tapstudy::analysis {
namespace {
// P(T >= t) of Student's t.
double upper_t_p(double t, double degrees_of_freedom) {
  const double half_of_both = f_p(t * t, 1.0, degrees_of_freedom) / 2.0;
  return t > 0.0 ? half_of_both : 1.0 - half_of_both;
}
}  // namespace

EquivalenceTest equivalence_test(const std::vector<double>& differences, double bound) {
  if (differences.size() < 2 || !(bound > 0.0) ||
      !std::ranges::all_of(differences, [](double value) { return std::isfinite(value); })) {
    throw core::InvalidInput{"equivalence takes two finite differences or more, and a bound"};
  }
  const MeanAndSpread all = mean_and_spread(differences);
  if (!(all.standard_deviation > 0.0)) {
    throw core::NotEstimable{"all differences are equal"};
  }
  constexpr double upper = 0.95;
  const double error = all.standard_deviation / std::sqrt(static_cast<double>(differences.size()));
  const double freedom = static_cast<double>(differences.size()) - 1.0;
  const double half_width = t_quantile(upper, freedom) * error;
  EquivalenceTest test{all.mean, {all.mean - half_width, all.mean + half_width}, 0.0, 0.0, 0.0};
  test.p_above = upper_t_p((all.mean + bound) / error, freedom);
  test.p_below = upper_t_p((bound - all.mean) / error, freedom);
  test.p = std::max(test.p_above, test.p_below);
  return test;
}

EquivalenceTest equivalence_test(const std::vector<Interval>& differences, double bound) {
  std::vector<double> exact;
  for (const Interval& range : differences) {
    if (range.low == range.high) {
      exact.push_back(range.low);
    }
  }
  if (exact.size() == differences.size()) {
    return equivalence_test(exact, bound);
  }
  constexpr double confidence = 0.9;
  const CensoredMean of = censored_mean(differences, confidence, {-bound, bound});
  const double freedom = static_cast<double>(differences.size()) - 1.0;
  EquivalenceTest test{of.mean, of.interval, upper_t_p(of.t[0], freedom),
                       upper_t_p(-of.t[1], freedom), 0.0};
  test.p = std::max(test.p_above, test.p_below);
  return test;
}

namespace {
using Interaction = std::vector<double>;  // of all cells, row by row

void check_tables(const std::vector<LevelTable>& values) {
  const auto is_like_first = [&](const LevelTable& table) {
    return table.size() == values.front().size() &&
           std::ranges::all_of(table, [&](const std::vector<double>& row) {
             return row.size() == values.front().front().size();
           });
  };
  if (values.size() < 2 || values.front().size() < 2 || values.front().front().size() < 2 ||
      !std::ranges::all_of(values, is_like_first)) {
    throw core::InvalidInput{
        "an interaction takes two participants or more, and two levels or more of both factors"};
  }
}

// What is left of one person's values without the means of rows and columns.
Interaction interaction_of(const LevelTable& table) {
  const auto rows = static_cast<double>(table.size());
  const auto columns = static_cast<double>(table.front().size());
  std::vector<double> of_columns(table.front().size());
  std::vector<double> of_rows;
  for (const std::vector<double>& row : table) {
    of_rows.push_back(std::accumulate(row.begin(), row.end(), 0.0) / columns);
    for (std::size_t i = 0; i < row.size(); ++i) {
      of_columns[i] += row[i] / rows;
    }
  }
  const double mean = std::accumulate(of_rows.begin(), of_rows.end(), 0.0) / rows;
  Interaction left;
  for (std::size_t row = 0; row < table.size(); ++row) {
    for (std::size_t i = 0; i < of_columns.size(); ++i) {
      left.push_back(table[row][i] - of_rows[row] - of_columns[i] + mean);
    }
  }
  return left;
}

double sum_of_squares(const Interaction& values) {
  return std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
}

// The square of the length of the sum of people's interactions with these signs: F grows with it,
// because the sum of their own squares is the same with any signs.
template <class IsPositive>
double squared_sum(const std::vector<Interaction>& people, const IsPositive& is_positive) {
  Interaction sum(people.front().size());
  for (std::size_t person = 0; person < people.size(); ++person) {
    const double sign = is_positive(person) ? 1.0 : -1.0;
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i] += sign * people[person][i];
    }
  }
  return sum_of_squares(sum);
}

constexpr std::size_t most_people_enumerated = 16;

double exact_share(const std::vector<Interaction>& people, double limit) {
  const std::size_t patterns = std::size_t{1} << (people.size() - 1);  // opposite ones are alike
  std::size_t as_far = 0;
  for (std::size_t pattern = 0; pattern < patterns; ++pattern) {
    const double sum =
        squared_sum(people, [&](std::size_t person) { return ((pattern >> person) & 1U) == 0; });
    as_far += sum >= limit ? 1 : 0;
  }
  return static_cast<double>(as_far) / static_cast<double>(patterns);
}

double drawn_p(const std::vector<Interaction>& people, double limit, std::uint64_t seed) {
  constexpr int drawn = 9999;
  const auto sums = replicates(
      drawn,
      [&](std::uint64_t own_seed) {
        core::Rng rng{own_seed};
        return squared_sum(people, [&](std::size_t /*person*/) { return rng.below(2) == 0; });
      },
      seed);
  return monte_carlo_p(sums, limit);
}
}  // namespace

InteractionTest interaction_test(const std::vector<LevelTable>& values, std::uint64_t seed) {
  check_tables(values);
  std::vector<Interaction> people;
  double own = 0.0;
  double size = 0.0;  // of the values, against which rounding is nothing
  for (const LevelTable& table : values) {
    people.push_back(interaction_of(table));
    own += sum_of_squares(people.back());
    for (const std::vector<double>& row : table) {
      size += sum_of_squares(row);
    }
  }
  constexpr double rounding = 1e-12;
  if (own <= rounding * rounding * size) {
    throw core::NotEstimable{"nobody's values have an interaction"};
  }
  const auto number = static_cast<double>(people.size());
  const double observed = squared_sum(people, [](std::size_t /*person*/) { return true; });
  const auto freedom =
      static_cast<double>((values.front().size() - 1) * (values.front().front().size() - 1));
  const double between = observed / number;
  const double within = own - between;
  const bool is_exact = people.size() <= most_people_enumerated;
  const double limit = observed - rounding * own * number;
  return {within > rounding * own ? between * (number - 1.0) / within
                                  : std::numeric_limits<double>::infinity(),
          freedom, freedom * (number - 1.0),
          is_exact ? exact_share(people, limit) : drawn_p(people, limit, seed), is_exact};
}
}  // namespace tapstudy::analysis
