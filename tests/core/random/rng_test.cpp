#include "core/random/rng.hpp"

#include <array>
#include <vector>

#include "support/catch.hpp"
using tapstudy::core::Rng;
TEST_CASE("the same seed gives the same order on every machine", "[core][rng]") {
  Rng rng{20240517};
  std::array order{0, 1, 2, 3, 4, 5, 6, 7};
  rng.shuffle(order);
  CAPTURE(order);
  CHECK(order == std::array{3, 2, 5, 0, 7, 4, 6, 1});  // known answer
}
TEST_CASE("below(n) reaches every value about equally often", "[core][rng]") {
  Rng rng{1};
  std::array<int, 6> hits{};
  for (int i = 0; i < 60'000; ++i) {
    ++hits[rng.below(6)];
  }
  for (const int h : hits) {
    CHECK(h == Approx(10'000).margin(400));
  }
}
TEST_CASE("uniform draws fill [0, 1) evenly and normal draws have mean 0 and variance 1",
          "[core][rng]") {
  Rng rng{3};
  constexpr int draws = 100'000;
  double mean = 0.0;
  double normal_mean = 0.0;
  double normal_square = 0.0;
  for (int i = 0; i < draws; ++i) {
    const double u = rng.uniform();
    REQUIRE((u >= 0.0 && u < 1.0));
    mean += u / draws;
    const double z = rng.normal();
    normal_mean += z / draws;
    normal_square += z * z / draws;
  }
  CHECK(mean == Approx(0.5).margin(0.004));  // four standard errors
  CHECK(normal_mean == Approx(0.0).margin(0.013));
  CHECK(normal_square == Approx(1.0).margin(0.018));
}
TEST_CASE("streams of different purposes have different seeds", "[core][rng]") {
  using tapstudy::core::derived_seed;
  using tapstudy::core::Purpose;
  CHECK(derived_seed(1, Purpose::hand) != derived_seed(1, Purpose::observer));
  CHECK(derived_seed(1, Purpose::hand, 0) != derived_seed(1, Purpose::hand, 1));
  CHECK(derived_seed(1, Purpose::hand) != derived_seed(2, Purpose::hand));
}
