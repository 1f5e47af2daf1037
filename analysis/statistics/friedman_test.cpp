#include "analysis/statistics/friedman_test.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "analysis/statistics/resampling/replicates.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
namespace tapstudy::analysis {
namespace {
// Twice a participant's mid-ranks less their mean: whole numbers that add up to 0.
using Ranks = std::vector<int>;

Ranks doubled_ranks(const std::vector<double>& row) {
  Ranks ranks;
  for (const double rank : mid_ranks(row)) {
    ranks.push_back(static_cast<int>(std::lround(2.0 * rank)) - static_cast<int>(row.size()) - 1);
  }
  return ranks;
}

void add_to(Ranks& sums, const Ranks& ranks) {
  std::ranges::transform(sums, ranks, sums.begin(), std::plus{});
}

template <class Sums>
double sum_of_squares(const Sums& sums) {
  return std::transform_reduce(sums.begin(), sums.end(), 0.0, std::plus{}, [](int sum) {
    return static_cast<double>(sum) * static_cast<double>(sum);
  });
}

// The orders of one participant's ranks that differ.
std::vector<Ranks> orders_of(Ranks ranks) {
  std::ranges::sort(ranks);
  std::vector<Ranks> orders;
  do {
    orders.push_back(ranks);
  } while (std::ranges::next_permutation(ranks).found);
  return orders;
}

constexpr std::size_t most_conditions = 7;
using RankSums = std::array<int, most_conditions>;  // 0 beyond the conditions

// Sorted.
RankSums with(RankSums sums, const Ranks& ranks) {
  std::ranges::transform(sums, ranks, sums.begin(), std::plus{});
  const auto end = sums.begin() + std::ssize(ranks);
  std::partial_sort(sums.begin(), end, end);  // sort: GCC 12 warns of bounds that are kept
  return sums;
}

// The probabilities of rank sums, in ascending order: which condition has which does not matter, so
// that the first participant's order does not either. Unset where there are too many.
std::optional<std::map<RankSums, double>> distribution_of_sums(const std::vector<Ranks>& people) {
  constexpr std::size_t most_steps = 400'000;
  if (people.front().size() > most_conditions) {
    return std::nullopt;
  }
  std::map<RankSums, double> sums{{with({}, people.front()), 1.0}};
  std::size_t steps = 0;
  for (std::size_t person = 1; person < people.size(); ++person) {
    const std::vector<Ranks> orders = orders_of(people[person]);
    steps += sums.size() * orders.size();
    if (steps > most_steps) {
      return std::nullopt;
    }
    std::map<RankSums, double> with_person;
    for (const auto& [before, p] : sums) {
      for (const Ranks& order : orders) {
        with_person[with(before, order)] += p / static_cast<double>(orders.size());
      }
    }
    sums = std::move(with_person);
  }
  return sums;
}

double random_sum_of_squares(const std::vector<Ranks>& people, std::uint64_t seed) {
  core::Rng rng{seed};
  Ranks sums(people.front().size(), 0);
  Ranks ranks;
  for (const Ranks& own : people) {
    ranks = own;
    rng.shuffle(ranks);
    add_to(sums, ranks);
  }
  return sum_of_squares(sums);
}

void add_p(const std::vector<Ranks>& people, double observed, std::uint64_t seed,
           FriedmanTest& test) {
  const auto distribution = distribution_of_sums(people);
  test.is_exact = distribution.has_value();
  if (!distribution) {
    constexpr int draws = 9999;
    test.p = monte_carlo_p(
        replicates(
            draws, [&](std::uint64_t draw) { return random_sum_of_squares(people, draw); }, seed),
        observed);
    return;
  }
  for (const auto& [sum, p] : *distribution) {
    test.p += sum_of_squares(sum) >= observed ? p : 0.0;
  }
  test.p = std::min(test.p, 1.0);
}
}  // namespace

FriedmanTest friedman_test(const RatingTable& ratings, std::uint64_t seed) {
  check_ratings(ratings);
  const auto n = static_cast<double>(ratings.size());
  const auto k = static_cast<double>(ratings.front().size());
  std::vector<Ranks> people;
  Ranks sums(ratings.front().size(), 0);
  double ties = 0.0;
  for (const std::vector<double>& row : ratings) {
    people.push_back(doubled_ranks(row));
    add_to(sums, people.back());
    ties += tie_sum(row);
  }
  const double spread = n * k * (k + 1.0) - ties / (k - 1.0);
  if (!(spread > 1e-9)) {
    throw core::NotEstimable{"every participant rates all conditions the same: nothing to test"};
  }
  FriedmanTest test;
  for (const int sum : sums) {
    test.mean_ranks.push_back(0.5 * (sum / n + k + 1.0));
  }
  const double squares = sum_of_squares(sums);  // of twice the deviations
  test.chi_squared = 3.0 * squares / spread;
  test.degrees_of_freedom = k - 1.0;
  test.kendalls_w = test.chi_squared / (n * (k - 1.0));
  add_p(people, squares, seed, test);
  return test;
}
}  // namespace tapstudy::analysis
