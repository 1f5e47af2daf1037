#include "analysis/blocks/pooled_proportion.hpp"

#include <fmt/format.h>

#include "analysis/participants/mean_proportion.hpp"
#include "support/catch.hpp"
using namespace tapstudy::analysis;

TEST_CASE("the interval of pooled answers is that over participants, never the score interval",
          "[analysis][participants]") {
  const std::vector<Proportion> people{{8, 8}, {7, 8}, {2, 8}, {1, 8}, {8, 8}, {0, 8}};
  const Cell cell = pooled_proportion(people);
  const auto over = mean_proportion(people);
  REQUIRE(over);
  CHECK(cell.values ==
        std::vector<Value>{26, 48, 26.0 / 48.0, over->interval.low, over->interval.high});
  const Interval score = wilson_interval({26, 48});
  CHECK(over->interval.high - over->interval.low > 1.5 * (score.high - score.low));
  CHECK_THAT(cell.text,
             Contains(fmt::format("26/48 = 54 % ({:.0f} % estimated over 6 participants, 95 % CI ",
                                  100.0 * over->mean)));
}

TEST_CASE("answers of one participant have their score interval, of none no share",
          "[analysis][participants]") {
  CHECK(pooled_proportion({{6, 8}}).values == proportion({6, 8}).values);
  const Cell none = pooled_proportion({{0, 0}, {0, 0}});
  CHECK(none.values == proportion({0, 0}).values);
  const Cell one_of_two = pooled_proportion({{6, 8}, {0, 0}});
  CHECK(one_of_two.values == std::vector<Value>{6, 8, 0.75, Value{}, Value{}});
  CHECK_THAT(one_of_two.text, !Contains("CI"));
}
