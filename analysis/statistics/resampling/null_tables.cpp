#include "analysis/statistics/resampling/null_tables.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <utility>

#include "analysis/statistics/numerics.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
double log_hypergeometric(std::int64_t k, std::int64_t marked, std::int64_t drawn,
                          std::int64_t population) {
  const auto log_ways = [](std::int64_t n, std::int64_t of) {
    return log_factorial(n) - log_factorial(of) - log_factorial(n - of);
  };
  return log_ways(marked, k) + log_ways(population - marked, drawn - k) -
         log_ways(population, drawn);
}
}  // namespace

namespace {
// The hypergeometric distribution of marked ones among `drawn` from `population`, `marked` of which
// are marked.
struct Hypergeometric {
  std::int64_t marked{};
  std::int64_t drawn{};
  std::int64_t population{};

  std::int64_t least() const { return std::max<std::int64_t>(0, drawn - (population - marked)); }
  std::int64_t most() const { return std::min(drawn, marked); }
  std::int64_t mode() const {
    const double at = static_cast<double>(drawn + 1) * static_cast<double>(marked + 1) /
                      static_cast<double>(population + 2);
    return std::clamp(static_cast<std::int64_t>(at), least(), most());
  }
  double mean() const {
    return static_cast<double>(drawn) * static_cast<double>(marked) /
           static_cast<double>(population);
  }
  double variance() const {
    const auto n = static_cast<double>(population);
    return mean() * (1.0 - static_cast<double>(marked) / n) *
           static_cast<double>(population - drawn) / (n - 1.0);
  }
};

// Outward from the mode: as many steps as the standard deviation.
std::int64_t by_inversion(const Hypergeometric& of, core::Rng& rng) {
  const auto [marked, drawn, population] = of;
  const std::int64_t least = of.least();
  const std::int64_t most = of.most();
  const std::int64_t mode = of.mode();
  // p(k + 1) / p(k)
  const auto ratio = [marked = marked, drawn = drawn, population = population](std::int64_t k) {
    return static_cast<double>(marked - k) * static_cast<double>(drawn - k) /
           (static_cast<double>(k + 1) * static_cast<double>(population - marked - drawn + k + 1));
  };
  double p_above = std::exp(log_hypergeometric(mode, marked, drawn, population));
  double p_below = p_above;
  double left = rng.uniform() - p_above;
  std::int64_t above = mode;
  std::int64_t below = mode;
  while (left >= 0.0 && (above < most || below > least)) {
    if (above < most) {
      p_above *= ratio(above);
      ++above;
      left -= p_above;
      if (left < 0.0) {
        return above;
      }
    }
    if (below > least) {
      --below;
      p_below /= ratio(below);
      left -= p_below;
      if (left < 0.0) {
        return below;
      }
    }
  }
  return mode;
}

// ln p(k), but for a constant.
double log_ways_of(const Hypergeometric& of, std::int64_t k) {
  return -(log_factorial(k) + log_factorial(of.marked - k) + log_factorial(of.drawn - k) +
           log_factorial(of.population - of.marked - of.drawn + k));
}

// Ratio of uniforms (Stadlober 1990, The ratio of uniforms approach for generating discrete random
// variates): (u, v) uniform in the rectangle around the region v^2 <= p(x) / p(mode), widened for
// the steps of a discrete distribution; x = mean + width (u - 1/2) / v.
std::int64_t by_ratio_of_uniforms(const Hypergeometric& of, core::Rng& rng) {
  const double width = 2.0 * std::sqrt(2.0 / std::numbers::e) * std::sqrt(of.variance() + 0.5) +
                       (3.0 - 2.0 * std::sqrt(3.0 / std::numbers::e));
  const double log_of_mode = log_ways_of(of, of.mode());
  while (true) {
    const double v = 1.0 - rng.uniform();  // above 0
    const double x = std::floor(of.mean() + 0.5 + width * (rng.uniform() - 0.5) / v);
    if (x < static_cast<double>(of.least()) || x > static_cast<double>(of.most())) {
      continue;
    }
    const auto k = static_cast<std::int64_t>(x);
    const double log_ratio = log_ways_of(of, k) - log_of_mode;
    // the first holds for all v^2 <= exp(log_ratio) that it lets pass, and spares a logarithm
    if (v * (4.0 - v) - 3.0 <= log_ratio || 2.0 * std::log(v) <= log_ratio) {
      return k;
    }
  }
}
}  // namespace

std::int64_t random_hypergeometric(std::int64_t marked, std::int64_t drawn, std::int64_t population,
                                   core::Rng& rng) {
  constexpr double most_steps = 20.0;  // beyond which inversion costs more
  const Hypergeometric of{marked, drawn, population};
  if (of.least() == of.most()) {
    return of.least();
  }
  return of.variance() > most_steps * most_steps ? by_ratio_of_uniforms(of, rng)
                                                 : by_inversion(of, rng);
}

namespace {
using Counts = std::vector<std::int64_t>;

// left: of each column's total, room that is taken once for many tables.
void add_random_table(const TableTotals& totals, core::Rng& rng, Counts& left, CountTable& sum) {
  left = totals.columns;
  std::int64_t all_left = totals.all;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    std::int64_t row_left = totals.rows[i];
    std::int64_t population = all_left;
    for (std::size_t j = 0; j < left.size(); ++j) {
      const std::int64_t cell = random_hypergeometric(left[j], row_left, population, rng);
      sum[i][j] += cell;
      population -= left[j];
      row_left -= cell;
      left[j] -= cell;
    }
    all_left -= totals.rows[i];
  }
}
}  // namespace

CountTable sum_of_random_tables(const std::vector<TableTotals>& totals, core::Rng& rng) {
  if (totals.empty()) {
    throw core::InvalidInput{"a sum of random tables takes one or more"};
  }
  CountTable sum(totals.front().rows.size(), Counts(totals.front().columns.size(), 0));
  Counts left;
  for (const TableTotals& of_table : totals) {
    add_random_table(of_table, rng, left, sum);
  }
  return sum;
}

CountTable random_table(const TableTotals& totals, core::Rng& rng) {
  return sum_of_random_tables({totals}, rng);
}

std::size_t work_of_random_tables(const std::vector<CountTable>& tables) {
  constexpr double work_of_a_cell = 10.0;
  double cells = 0.0;
  double answers = 0.0;
  for (const CountTable& table : tables) {
    const TableTotals totals = totals_of(table);
    cells += static_cast<double>(totals.rows.size() * totals.columns.size());
    answers += static_cast<double>(totals.all);
  }
  return static_cast<std::size_t>(cells * work_of_a_cell + std::sqrt(answers * cells));
}

namespace {
struct Shape {
  std::size_t stimuli{};
  std::size_t responses{};
  CountTable empty() const { return CountTable(stimuli, std::vector<std::int64_t>(responses, 0)); }
};

void count(const std::vector<int>& stimuli, const std::vector<int>& responses, CountTable& table) {
  for (std::size_t i = 0; i < responses.size(); ++i) {
    ++table.at(static_cast<std::size_t>(stimuli.at(i))).at(static_cast<std::size_t>(responses[i]));
  }
}
}  // namespace

NullTables redrawn_tables(std::vector<Answers> participants, Redraw redraw, std::size_t stimuli,
                          std::size_t responses) {
  const Shape shape{stimuli, responses};
  NullTables tables{shape.empty(), {}, 0};
  for (const Answers& answers : participants) {
    if (answers.stimuli.size() != answers.responses.size()) {
      throw core::InvalidInput{"a participant has not as many stimuli as responses"};
    }
    count(answers.stimuli, answers.responses, tables.observed);
    tables.work += answers.responses.size();
  }
  const auto shared = std::make_shared<const std::vector<Answers>>(std::move(participants));
  tables.draw = [shape, shared, redraw = std::move(redraw)](std::uint64_t seed) {
    CountTable table = shape.empty();
    for (std::size_t person = 0; person < shared->size(); ++person) {
      count(redraw(person, seed), (*shared)[person].responses, table);
    }
    return table;
  };
  return tables;
}

NullTables shuffled_tables(const std::vector<CountTable>& participants) {
  NullTables tables{sum_of(participants), {}, work_of_random_tables(participants)};
  std::vector<TableTotals> totals;
  std::ranges::transform(participants, std::back_inserter(totals), totals_of);
  tables.draw = [totals](std::uint64_t seed) {
    core::Rng rng{seed};
    return sum_of_random_tables(totals, rng);
  };
  return tables;
}

namespace {
std::vector<double> right_in(const CountTable& counts, const std::vector<RightAnswers>& notions) {
  std::vector<double> right(notions.size(), 0.0);
  for (std::size_t notion = 0; notion < notions.size(); ++notion) {
    for (std::size_t i = 0; i < counts.size(); ++i) {
      for (std::size_t j = 0; j < counts[i].size(); ++j) {
        right[notion] += notions[notion].at(i).at(j) ? static_cast<double>(counts[i][j]) : 0.0;
      }
    }
  }
  return right;
}
}  // namespace

std::vector<PermutationResult> permutation_tests(const NullTables& tables,
                                                 const std::vector<RightAnswers>& notions,
                                                 int draws, std::uint64_t seed) {
  const std::vector<double> observed = right_in(tables.observed, notions);
  const auto drawn = replicated_vectors(
      draws, [&](std::uint64_t own_seed) { return right_in(tables.draw(own_seed), notions); },
      seed);
  std::vector<PermutationResult> results;
  for (std::size_t notion = 0; notion < notions.size(); ++notion) {
    const auto as_good = std::ranges::count_if(
        drawn, [&](const std::vector<double>& right) { return right[notion] >= observed[notion]; });
    results.push_back({(1.0 + static_cast<double>(as_good)) / (static_cast<double>(draws) + 1.0),
                       static_cast<int>(as_good), draws});
  }
  return results;
}
}  // namespace tapstudy::analysis
