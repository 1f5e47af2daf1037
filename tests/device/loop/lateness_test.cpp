#include "device/loop/lateness.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/rng.hpp"
#include "support/catch.hpp"
using namespace tapstudy;

TEST_CASE("a share of the ticks is told to 19 %, from above", "[device][loop]") {
  core::Rng rng{1};
  device::LatenessCount count;
  std::vector<device::Nanoseconds> all;
  for (int i = 0; i < 20000; ++i) {
    all.push_back(static_cast<device::Nanoseconds>(std::exp(10.0 + 2.0 * rng.normal())));
    count.add(all.back());
  }
  std::ranges::sort(all);
  for (const double share : {0.5, 0.99, 0.999, 1.0}) {
    const auto place = static_cast<std::size_t>(std::ceil(share * 20000.0)) - 1;
    const auto truth = static_cast<double>(all[place]);
    CAPTURE(share, truth);
    CHECK(static_cast<double>(count.quantile(share)) >= truth);
    CHECK(static_cast<double>(count.quantile(share)) <= 1.19 * truth + 1.0);
  }
  CHECK(count.worst() == all.back());
}

TEST_CASE("nothing late is told as nothing", "[device][loop]") {
  device::LatenessCount count;
  CHECK(count.quantile(0.999) == 0);
  count.add(0);
  count.add(-5);
  CHECK(count.quantile(0.999) == 0);
}
