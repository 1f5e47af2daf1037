#include "analysis/statistics/sison_glaz.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/python_program.hpp"
using namespace tapstudy;

TEST_CASE("Sison and Glaz's intervals of choices are those of statsmodels", "[analysis][choice]") {
  const std::vector<std::vector<int>> choices{{7, 2, 1},        {10, 9, 8, 3},
                                              {30, 40, 50, 3},  {6, 4},
                                              {12, 0, 3},       {56, 72, 73, 59, 62, 87, 58},
                                              {101, 250, 3, 17}};
  for (const auto& counts : choices) {
    const auto expected = testing::python_numbers(fmt::format(
        "from statsmodels.stats.proportion import multinomial_proportions_confint as confint\n"
        "out(confint([{}], method='sison-glaz'))\n",
        fmt::join(counts, ",")));
    const std::vector<analysis::Interval> found = analysis::sison_glaz_intervals(counts);
    REQUIRE(expected.size() == 2 * found.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      INFO(fmt::format("{} of [{}]", i, fmt::join(counts, ",")));
      CHECK(found[i].low == Approx(expected[2 * i]).margin(1e-9));
      CHECK(found[i].high == Approx(expected[2 * i + 1]).epsilon(1e-9));
    }
  }
}

TEST_CASE("Sison and Glaz's intervals of few and one-sided counts stay within 0 and 1",
          "[analysis][choice]") {
  for (const std::vector<int>& counts : {std::vector{1, 0}, {1, 1}, {0, 0, 3}, {5, 0}, {2, 1, 0}}) {
    const std::vector<analysis::Interval> found = analysis::sison_glaz_intervals(counts);
    double all = 0.0;
    for (const int count : counts) {
      all += count;
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
      INFO(fmt::format("{} of [{}]", i, fmt::join(counts, ",")));
      CHECK(found[i].low >= 0.0);
      CHECK(found[i].low <= counts[i] / all);
      CHECK(found[i].high >= counts[i] / all);
      CHECK(found[i].high <= 1.0);
    }
  }
  CHECK_THROWS_AS(analysis::sison_glaz_intervals({3}), core::InvalidInput);
  CHECK_THROWS_AS(analysis::sison_glaz_intervals({0, 0}), core::InvalidInput);
}
