#include "analysis/statistics/simultaneous.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/python_program.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

TEST_CASE("simultaneous intervals of choices are Goodman's, as statsmodels has them",
          "[analysis][choice]") {
  const std::vector<std::vector<int>> choices{{7, 2, 1}, {10, 0, 0}, {1, 0}, {30, 40, 50, 3}};
  std::string script =
      "from statsmodels.stats.proportion import multinomial_proportions_confint as ci\n";
  for (const auto& counts : choices) {
    script += fmt::format("out(ci(np.array({}), method='goodman'))\n", counts);
  }
  const auto expected = testing::python_numbers(script);
  std::size_t at = 0;
  for (const auto& counts : choices) {
    for (const Interval& interval : simultaneous_intervals(counts)) {
      CHECK(interval.low == Approx(expected[at]).margin(1e-12));
      CHECK(interval.high == Approx(expected[at + 1]).epsilon(1e-9));
      at += 2;
    }
  }
  CHECK_THROWS_AS(simultaneous_intervals({5}), core::InvalidInput);
  CHECK_THROWS_AS(simultaneous_intervals({0, 0}), core::InvalidInput);
  CHECK_THROWS_AS(simultaneous_intervals({3, -1}), core::InvalidInput);
}
