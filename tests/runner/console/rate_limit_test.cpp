#include "runner/console/rate_limit.hpp"

#include "support/catch.hpp"
using namespace tapstudy::runner;
using namespace std::chrono_literals;

TEST_CASE("a burst passes without delay, and what follows it at the rate", "[runner][console]") {
  RateLimit limit{10.0, 5.0};
  const RateLimit::Time begin{1h};
  for (int i = 0; i < 5; ++i) {
    CHECK(limit.delay_of(1.0, begin) == 0s);
  }
  CHECK(limit.delay_of(1.0, begin) == 100ms);
  CHECK(limit.delay_of(2.0, begin) == 300ms);
  CHECK(limit.delay_of(1.0, begin + 1s) == 0s);
}

TEST_CASE(
    "who asks no faster than the rate never waits, and idleness saves up no more than a burst",
    "[runner][console]") {
  RateLimit limit{10.0, 5.0};
  RateLimit::Time now{1h};
  for (int i = 0; i < 100; ++i, now += 100ms) {
    CHECK(limit.delay_of(1.0, now) == 0s);
  }
  now += 1h;
  CHECK(limit.delay_of(5.0, now) == 0s);
  CHECK(limit.delay_of(1.0, now) == 100ms);
}
