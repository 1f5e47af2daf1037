#include "core/techniques/resampled.hpp"

#include <cmath>
#include <numbers>

#include "support/catch.hpp"
using namespace tapstudy;

namespace {
constexpr double pi = std::numbers::pi;
double transient(double t_s, double phase_rad) {
  return std::exp(-30.0 * t_s) * std::cos(2.0 * pi * 150.0 * t_s + phase_rad);
}
std::vector<double> sampled(double rate_hz, double phase_rad) {
  std::vector<double> samples;
  for (int n = 0; n < static_cast<int>(0.1 * rate_hz); ++n) {
    samples.push_back(transient(n / rate_hz, phase_rad));
  }
  return samples;
}
}  // namespace

TEST_CASE("a transient keeps its onset at another rate", "[core][recorded]") {
  for (const double from_hz : {10000.0, 4000.0, 1500.0, 44100.0}) {
    for (const double phase_rad : {0.0, -pi / 2.0, 0.7}) {
      CAPTURE(from_hz, phase_rad);
      const auto played = core::resampled(sampled(from_hz, phase_rad), from_hz, 1000.0);
      REQUIRE(played.size() >= 90);
      CHECK(played[0] == Approx(transient(0.0, phase_rad)).margin(2e-3));
      for (int n = 0; n < 60; ++n) {
        CHECK(played[static_cast<std::size_t>(n)] ==
              Approx(transient(n / 1000.0, phase_rad)).margin(0.05));
      }
    }
  }
}
