#include "results/trace_collector.hpp"

#include <algorithm>

#include "support/catch.hpp"
using namespace tapstudy;

TEST_CASE("an impact up to 5 ms after a late tick is noted as one, and no other is",
          "[results][trace]") {
  const int ticks_after = GENERATE(0, 1, 5, 6, 50);
  core::SpscRing<core::TraceSample> ring{256};
  for (int i = 0; i < 100; ++i) {
    core::TraceSample sample{};
    sample.t_ns = 1'000'000 * i;
    sample.late = i == 40;
    sample.impact = i == 40 + ticks_after || i == 30;
    sample.velocity_m_s = {0.0, -0.3, 0.0};
    REQUIRE(ring.try_push(sample));
  }
  const auto events = results::TraceCollector{ring}.finish().events;
  CHECK(std::ranges::count(events, "impact", &results::EventRow::kind) == 2);
  const auto late = std::ranges::find(events, "late_impact", &results::EventRow::kind);
  REQUIRE((late != events.end()) == (ticks_after <= 5));
  if (ticks_after <= 5) {
    CHECK(late->value == Approx(0.3));
    CHECK(late->t_s == Approx(0.04 + 0.001 * ticks_after));
  }
}
