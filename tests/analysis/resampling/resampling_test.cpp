#include <cmath>
#include <map>
#include <stdexcept>

#include "analysis/resampling/random_table.hpp"
#include "analysis/resampling/replicates.hpp"
#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/log_factorial.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/confusion_tables.hpp"
#include "support/r_program.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using namespace tapstudy::testing;

TEST_CASE("replicates do not depend on how many threads compute them",
          "[analysis][resampling][threads]") {
  const Replicate draw = [](std::uint64_t seed) { return core::Rng{seed}.uniform(); };
  const auto alone = replicates(101, draw, 7, 1);
  CHECK(replicates(101, draw, 7, 2) == alone);
  CHECK(replicates(101, draw, 7, 5) == alone);
  CHECK(replicates(101, draw, 7) == alone);
  CHECK(replicates(101, draw, 8) != alone);
  CHECK(replicates(3, draw, 7, 16).size() == 3);
  CHECK(replicates(0, draw, 7).empty());
  CHECK_THROWS_AS(replicates(-1, draw, 7), core::InvalidInput);
  CHECK_THROWS_AS(replicates(
                      8, [](std::uint64_t) -> double { throw std::runtime_error{"failed"}; }, 1, 2),
                  std::runtime_error);
}

TEST_CASE("a random table has the totals of its pattern", "[analysis][resampling]") {
  core::Rng rng{3};
  for (const CountTable& table : all_tables()) {
    const TableTotals totals = totals_of(table);
    for (int draw = 0; draw < 50; ++draw) {
      const TableTotals drawn = totals_of(random_table(totals, rng));
      CHECK(drawn.rows == totals.rows);
      CHECK(drawn.columns == totals.columns);
    }
  }
}

TEST_CASE("cells of random tables are drawn as R's hypergeometric distribution says",
          "[analysis][resampling]") {
  constexpr int draws = 20'000;
  for (const auto& [marked, drawn, population] : {std::tuple{20, 20, 80},
                                                  {3, 4, 7},
                                                  {500, 300, 2400},
                                                  {9, 8, 10},
                                                  {40'000, 20'000, 80'000},
                                                  {1'500, 70'000, 80'000},
                                                  {50'000, 3'000, 80'000}}) {
    core::Rng rng{5};
    std::map<std::int64_t, int> seen;
    for (int i = 0; i < draws; ++i) {
      ++seen[random_hypergeometric(marked, drawn, population, rng)];
    }
    double chi_squared = 0.0;
    int cells = 0;
    const auto r =
        r_numbers(fmt::format("p <- dhyper(0:{}, {}, {}, {}); out(ifelse(p < 1e-300, 0, p))", drawn,
                              marked, population - marked, drawn));
    for (std::size_t k = 0; k < r.size(); ++k) {
      const double expected = r[k] * draws;
      const int observed = seen[static_cast<std::int64_t>(k)];
      if (expected < 5.0) {
        CHECK(observed <= 25);
        continue;
      }
      chi_squared += (observed - expected) * (observed - expected) / expected;
      ++cells;
    }
    CHECK(chi_squared_p(chi_squared, cells) > 1e-4);
  }
}

TEST_CASE("the logarithm of a factorial is R's", "[analysis][resampling]") {
  const auto r = r_numbers("out(lfactorial(c(0, 1, 5, 1023, 1024, 1025, 1e6)))");
  std::size_t at = 0;
  for (const std::int64_t n : {0, 1, 5, 1023, 1024, 1025, 1'000'000}) {
    CHECK(log_factorial(n) == Approx(r[at]).epsilon(1e-13));
    ++at;
  }
}
