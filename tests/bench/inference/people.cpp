#include "inference/people.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/rank_tests.hpp"
namespace tapstudy::bench {
using analysis::Proportion;

std::size_t guess(Guesser guesser, std::size_t answers, std::optional<std::size_t> last,
                  core::Rng& rng) {
  const auto any = [&](std::size_t of) { return rng.below(static_cast<std::uint32_t>(of)); };
  if (guesser == Guesser::of_habit) {
    return rng.uniform() < 0.8 ? 0 : 1 + any(answers - 1);
  }
  if (guesser == Guesser::reluctant_to_repeat && last) {
    const bool is_again = rng.uniform() < 0.5 / static_cast<double>(answers);
    return is_again ? *last : (*last + 1 + any(answers - 1)) % answers;
  }
  return any(answers);
}

std::vector<std::size_t> shuffled(std::size_t kinds, int each, core::Rng& rng) {
  std::vector<std::size_t> order;
  for (int i = 0; i < each; ++i) {
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      order.push_back(kind);
    }
  }
  rng.shuffle(order);
  return order;
}

double personal_share(double mean, double intraclass_correlation, core::Rng& rng) {
  if (intraclass_correlation <= 0.0) {
    return mean;
  }
  std::mt19937_64 generator{rng()};
  const double nu = 1.0 / intraclass_correlation - 1.0;
  const double a = std::gamma_distribution<>{nu * mean}(generator);
  return a / (a + std::gamma_distribution<>{nu * (1.0 - mean)}(generator));
}

Proportion answered(double share, int trials, core::Rng& rng) {
  Proportion of;
  for (int i = 0; i < trials; ++i) {
    of.add(rng.uniform() < share);
  }
  return of;
}

std::vector<Proportion> sample_of(double mean, Trials trials, const StudyDraw& draw) {
  std::vector<Proportion> drawn;
  for (int i = 0; i < draw.people; ++i) {
    const double share = personal_share(mean, draw.intraclass_correlation, draw.rng);
    const bool stops = trials == Trials::some_stop ? draw.rng.uniform() < 0.4 : share < mean;
    drawn.push_back(answered(share, trials == Trials::equal ? 16 : stops ? 6 : 30, draw.rng));
  }
  return drawn;
}

double share_further_by_signs(const std::vector<double>& differences, core::Rng& rng) {
  std::vector<double> sizes;
  std::ranges::copy_if(differences, std::back_inserter(sizes), [](double d) { return d != 0.0; });
  const double limit = std::abs(std::accumulate(sizes.begin(), sizes.end(), 0.0)) + 1e-9;
  constexpr std::size_t most_enumerated = 9;
  const bool is_exact = sizes.size() <= most_enumerated;
  const std::uint32_t patterns = is_exact ? 1U << sizes.size() : 999U;
  int further = 0;
  for (std::uint32_t pattern = 0; pattern < patterns; ++pattern) {
    const std::uint64_t signs = is_exact ? pattern : rng();
    double sum = 0.0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      sum += ((signs >> i) & 1U) != 0 ? sizes[i] : -sizes[i];
    }
    further += std::abs(sum) > limit ? 1 : 0;
  }
  return static_cast<double>(further) / static_cast<double>(patterns);
}

Outcome sign_flips_of(const std::vector<double>& differences, core::Rng& rng) {
  return {analysis::sign_flip_test(differences, 1).p, share_further_by_signs(differences, rng)};
}

Outcome sign_test_of(const std::vector<double>& differences) {
  const analysis::SignTest test = analysis::sign_test(differences);
  const Proportion further{test.above.successes + 1, test.above.trials};
  return {test.p, further.successes > further.trials || further.trials == 0
                      ? 0.0
                      : analysis::binomial_p_at_least(further, 0.5)};
}

Outcome accuracy_against(const analysis::NullTables& tables, std::uint64_t seed) {
  const auto right_in = [](const analysis::CountTable& counts) {
    std::int64_t right = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      right += counts[i][i];
    }
    return right;
  };
  const std::int64_t observed = right_in(tables.observed);
  core::Rng rng{seed};
  int better = 0;
  int as_good = 0;
  for (int i = 0; i < draws_of_a_test; ++i) {
    const std::int64_t drawn = right_in(tables.draw(rng()));
    better += drawn > observed ? 1 : 0;
    as_good += drawn >= observed ? 1 : 0;
  }
  const auto p_of = [](int number) { return number / (draws_of_a_test + 1.0); };
  return {p_of(1 + as_good), p_of(better)};
}
}  // namespace tapstudy::bench
