// Which ticks make a tap that can be felt.
#include "runner/participants/touch_features.hpp"

#include "core/placement.hpp"
#include "support/catch.hpp"
using namespace tapstudy;

namespace {
constexpr double dt_s = 1e-3;
constexpr double threshold_n = 1e-4;

// Alternately in contact and off, so many milliseconds each, beginning off.
std::vector<device::FeltTick> felt(const std::vector<int>& lengths_ms) {
  std::vector<device::FeltTick> ticks;
  bool is_contact = false;
  double x_m = 0.0;
  for (const int length : lengths_ms) {
    for (int i = 0; i < length; ++i) {
      device::FeltTick tick{};
      tick.hand.position_m = core::Vec3{x_m, 0.0, 0.0};
      tick.hand.position_m[core::normal_axis] = is_contact ? -0.001 : 0.01;
      tick.force_n = core::Vec3::Zero();
      tick.force_n[core::normal_axis] = is_contact ? 2.0 : 0.0;
      ticks.push_back(tick);
    }
    is_contact = !is_contact;
    x_m += 0.001;  // so that places tell contacts apart
  }
  return ticks;
}
std::vector<double> places_of_taps(const std::vector<int>& lengths_ms) {
  std::vector<double> places;
  for (const runner::FeltTap& tap : runner::felt_taps(felt(lengths_ms), dt_s, threshold_n)) {
    places.push_back(tap.place_m.x());
  }
  return places;
}
}  // namespace

TEST_CASE("a tap begins at its impact, also where the finger bounces", "[runner][observer]") {
  CHECK(places_of_taps({100, 200, 100}) == std::vector{0.001});
  CHECK(places_of_taps({100, 25, 10, 200, 100}) == std::vector{0.001});
  CHECK(places_of_taps({100, 25, 10, 20, 20, 200, 100}) == std::vector{0.001});
  CHECK(places_of_taps({100, 25, 60, 200, 100}) == std::vector{0.003});  // two touches
  CHECK(places_of_taps({100, 25, 10, 50, 100}).empty());                 // too short to feel
  CHECK(places_of_taps({100, 200, 100, 25, 10, 200, 100}) == std::vector{0.001, 0.003});
}
