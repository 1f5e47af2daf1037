#include "analysis/modal_identification/spring_update.hpp"

#include <cmath>

#include "core/rng.hpp"
#include "support/catch.hpp"
using namespace tapstudy;

namespace {
constexpr double modulus_pa = 3e9;

// Two masses between springs to the ground and springs of the body itself, and others like it: each
// frequency squared is a stiffness of the body and one of the springs, side by side.
std::vector<double> frequencies_hz(double spring_factor) {
  std::vector<double> all;
  for (const double springs : {3.0, 0.6, 0.1, 0.4}) {
    const double first_hz = 40.0 + 60.0 * static_cast<double>(all.size());
    all.push_back(first_hz * std::sqrt(1.0 + springs * spring_factor));
  }
  return all;
}
// Measured of a body of other elasticity, on other springs, with errors.
std::vector<analysis::Estimate> measured(double modulus_factor, double spring_factor, double error,
                                         core::Rng& rng) {
  std::vector<analysis::Estimate> all;
  for (const double hz : frequencies_hz(spring_factor / modulus_factor)) {
    all.push_back({hz * std::sqrt(modulus_factor) * std::exp(error * rng.normal()), 0.0, {}, {}});
  }
  return all;
}
}  // namespace

TEST_CASE("springs and modulus planted in frequencies come back", "[analysis][identify]") {
  core::Rng rng{1};
  const auto [modulus, springs] =
      GENERATE(table<double, double>({{1.0, 0.3}, {0.8, 4.0}, {1.2, 1.0}}));
  const auto found =
      analysis::update_springs(measured(modulus, springs, 0.0, rng), frequencies_hz, modulus_pa);
  REQUIRE(found);
  CHECK(found->model.youngs_modulus_pa.value == Approx(modulus * modulus_pa).epsilon(1e-3));
  CHECK(found->spring_factor.value == Approx(springs).epsilon(3e-3));
  CHECK(found->model.matched.size() == 4);
}

TEST_CASE("the intervals of springs and modulus cover what was planted 95 times in 100",
          "[analysis][identify]") {
  core::Rng rng{2};
  constexpr int studies = 1000;
  int springs = 0;
  int modulus = 0;
  for (int i = 0; i < studies; ++i) {
    const auto found =
        analysis::update_springs(measured(1.1, 0.7, 0.003, rng), frequencies_hz, modulus_pa);
    REQUIRE(found);
    const auto covers = [](const analysis::Estimate& estimate, double planted) {
      return estimate.interval.low <= planted && planted <= estimate.interval.high;
    };
    springs += covers(found->spring_factor, 0.7) ? 1 : 0;
    modulus += covers(found->model.youngs_modulus_pa, 1.1 * modulus_pa) ? 1 : 0;
  }
  // 950 ± 6.9 would be exact; four standard errors
  CHECK(std::abs(springs - 950) <= 28);
  CHECK(std::abs(modulus - 950) <= 28);
}

TEST_CASE("springs of which the modes do not tell are not stated", "[analysis][identify]") {
  const auto rigid = [](double) { return std::vector<double>{40.0, 100.0, 180.0, 260.0}; };
  core::Rng rng{3};
  CHECK_FALSE(analysis::update_springs(measured(1.0, 1.0, 0.0, rng), rigid, modulus_pa));
  auto two = measured(1.0, 1.0, 0.0, rng);
  two.resize(2);
  CHECK_FALSE(analysis::update_springs(two, frequencies_hz, modulus_pa));
}
