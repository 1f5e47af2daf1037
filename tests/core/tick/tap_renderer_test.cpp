#include "core/tick/tap_renderer.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "core/model/plate_model.hpp"
#include "core/techniques/technique.hpp"
#include "core/tick/force_limiter.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
#include "support/plates.hpp"
using namespace tapstudy::core;
namespace testing = tapstudy::testing;

namespace {
const VibratingPlate& tapped_plate() {
  static const VibratingPlate shared{
      build_plate_model(testing::paper_plate(2, testing::mdf())).modal};
  return shared;
}
bool has(const Technique& technique, const ForcePart& part) {
  return std::ranges::find(technique.parts, &part) != technique.parts.end();
}
RenderSettings settings() {
  RenderSettings all;
  all.sinusoid.amplitude_n_s_per_m = 3.0;
  all.recorded_taps = std::make_shared<const RecordedTaps>(
      RecordedTaps{1.0 / all.dt_s, {{{0.0, 0.0}, 0.3, {0.1, -0.1}}}});
  return all;
}
// A finger that goes straight in at 0.3 m/s and stays 2 mm deep.
std::vector<RenderedTick> tapped(const char* technique, double x_m, double y_m) {
  TapRenderer renderer =
      make_renderer(*find_technique(technique), settings(), PlateFace{0.3, 0.3}, &tapped_plate());
  std::vector<RenderedTick> ticks;
  renderer.tick({{x_m, y_m, 0.001}, {0.0, 0.0, -0.3}});
  for (int tick = 0; tick < 300; ++tick) {
    const double depth_m = std::min(0.002, 0.0002 + 3e-4 * tick);
    ticks.push_back(renderer.tick({{x_m, y_m, -depth_m}, {0.0, 0.0, -0.3}}));
  }
  return ticks;
}
}  // namespace

TEST_CASE("on a plate of half the lateral scale the finger is twice as far out and no deeper",
          "[core][technique]") {
  RenderSettings half = settings();
  half.lateral_ratio = 0.5;
  TapRenderer renderer = make_renderer(*find_technique("none"), half, PlateFace{0.3, 0.3}, nullptr);
  renderer.tick({{0.1, 0.05, 0.001}, {0.0, 0.0, -0.3}});
  const RenderedTick touched = renderer.tick({{0.1, 0.05, -0.001}, {0.0, 0.0, -0.3}});
  CHECK(touched.contact.god_object_m.isApprox(Vec3{0.2, 0.1, 0.0}));
  CHECK(touched.force_n.isApprox(Vec3{0.0, 0.0, 3.0}));
}

TEST_CASE("a switch to a plate of another lateral scale keeps the finger where it is",
          "[core][technique]") {
  const auto renderer_with = [](double ratio) {
    RenderSettings own = settings();
    own.lateral_ratio = ratio;
    return make_renderer(*find_technique("none"), own, PlateFace{0.3, 0.3}, nullptr);
  };
  TapRenderer wide = renderer_with(0.1);
  TapRenderer narrow = renderer_with(1.0);
  wide.tick({{0.02, 0.01, 0.001}, {0.0, 0.0, -0.3}});
  narrow.take_over_from(wide);
  const RenderedTick touched = narrow.tick({{0.02, 0.01, -0.001}, {0.0, 0.0, -0.3}});
  CHECK(touched.contact.god_object_m.isApprox(Vec3{0.02, 0.01, 0.0}));
}

TEST_CASE("every technique has the penalty force of eq. 1 and is the sum of its parts (eq. 18)",
          "[core][technique]") {
  for (const Technique& technique : techniques()) {
    INFO(technique.name);
    for (const RenderedTick& tick : tapped(technique.name.data(), 0.2, 0.2)) {
      CHECK(tick.parts.penalty_n == Approx(3000.0 * tick.contact.penetration_m));
      CHECK(tick.force_n.z() ==
            Approx(tick.parts.penalty_n + tick.parts.vibration_n + tick.parts.sinusoid_n));
      CHECK(tick.force_n.head<2>().norm() == 0.0);
      const bool can_vibrate = technique.needs_model() || has(technique, recorded_transient);
      CHECK((tick.parts.vibration_n == 0.0 || can_vibrate));
      CHECK((tick.parts.sinusoid_n == 0.0 || has(technique, decaying_sinusoid)));
    }
  }
}

TEST_CASE("the sinusoid is the same wherever one taps and follows its formula",
          "[core][technique]") {
  const auto here = tapped("sinusoid", 0.2, 0.2);
  const auto there = tapped("sinusoid", -0.25, 0.0);
  for (std::size_t tick = 0; tick < here.size(); ++tick) {
    CHECK(here[tick].parts.sinusoid_n == there[tick].parts.sinusoid_n);
    const double t = 1e-3 * static_cast<double>(tick);
    CHECK(here[tick].parts.sinusoid_n ==
          Approx(0.9 * std::exp(-600.0 * t) * std::sin(2.0 * M_PI * 250.0 * t)).margin(1e-12));
  }
}

TEST_CASE("after missed periods every technique's force is what it is where none were missed",
          "[core][technique]") {
  // straight in, a little deeper with each period, and out again
  const auto tip_at = [](int period) -> HandState {
    const double depth_m = period < 250 ? 0.001 + 1e-5 * period : -0.002;
    return {{0.2, 0.2, -depth_m}, {0.0, 0.0, -0.01}};
  };
  const int missed = GENERATE(1, 2, 7);
  for (const Technique& technique : techniques()) {
    INFO(technique.name);
    const auto renderer = [&] {
      TapRenderer made = make_renderer(technique, settings(), PlateFace{0.3, 0.3}, &tapped_plate());
      made.tick({{0.2, 0.2, 0.001}, {0.0, 0.0, -0.3}});
      made.tick(tip_at(0));
      return made;
    };
    TapRenderer whole = renderer();
    TapRenderer sparse = renderer();
    for (int period = 1; period <= 300; ++period) {
      const RenderedTick expected = whole.tick(tip_at(period));
      const bool is_made = period % (missed + 1) == 0;
      if (is_made) {
        const RenderedTick made = sparse.tick(tip_at(period), missed + 1);
        CHECK(made.force_n.z() == Approx(expected.force_n.z()).margin(1e-9));
        if (period < 250) {
          CHECK(sparse.energy_j() == Approx(whole.energy_j()).margin(1e-15));
        }
      }
    }
  }
}

TEST_CASE("the plate's vibration depends on where one taps", "[core][technique]") {
  const auto corner = tapped("fem", 0.24, 0.24);
  const auto fixed = tapped("fem", -0.29, -0.29);
  double largest_at_corner = 0.0;
  double largest_at_fixed = 0.0;
  for (std::size_t tick = 0; tick < corner.size(); ++tick) {
    largest_at_corner = std::max(largest_at_corner, std::abs(corner[tick].parts.vibration_n));
    largest_at_fixed = std::max(largest_at_fixed, std::abs(fixed[tick].parts.vibration_n));
  }
  CHECK(largest_at_corner > 20.0 * largest_at_fixed);
}

TEST_CASE("a tap pushes the plate away from the finger", "[core][technique]") {
  CHECK(tapped("fem", 0.24, 0.24).front().parts.vibration_n < 0.0);
}

TEST_CASE("fem+sinusoid is fem and sinusoid together", "[core][technique]") {
  const auto fem = tapped("fem", 0.1, 0.24);
  const auto sinusoid = tapped("sinusoid", 0.1, 0.24);
  const auto both = tapped("fem+sinusoid", 0.1, 0.24);
  for (std::size_t tick = 0; tick < both.size(); ++tick) {
    CHECK(both[tick].parts.vibration_n == fem[tick].parts.vibration_n);
    CHECK(both[tick].parts.sinusoid_n == sinusoid[tick].parts.sinusoid_n);
  }
}

TEST_CASE("nothing is felt off the plate", "[core][technique][safety]") {
  TapRenderer renderer = make_renderer(*find_technique("fem+sinusoid"), settings(),
                                       PlateFace{0.3, 0.3}, &tapped_plate());
  renderer.tick({{0.0, 0.0, 0.001}, {0.0, 0.0, -1.0}});
  renderer.tick({{0.0, 0.0, -0.001}, {0.0, 0.0, -1.0}});
  CHECK(renderer.tick({{0.0, 0.0, 0.0001}, Vec3::Zero()}).force_n == Vec3::Zero());
}

TEST_CASE("rendering allocates nothing", "[core][technique][realtime]") {
  TapRenderer renderer = make_renderer(*find_technique("fem+sinusoid"), settings(),
                                       PlateFace{0.3, 0.3}, &tapped_plate());
  const testing::AllocationCount allocations;
  for (int tick = 0; tick < 10'000; ++tick) {
    renderer.tick({{0.0001 * (tick % 1000), 0.0, 0.002 * std::sin(0.05 * tick)}, Vec3::Zero()});
  }
  CHECK(allocations.count() == 0);
}

using tapstudy::core::ForceLimits;
using tapstudy::core::limit_force;
using tapstudy::core::Vec3;
TEST_CASE("a force over the limit is shortened and keeps its direction", "[core][force_limiter]") {
  const ForceLimits limits{.max_force_n = 5.0, .max_force_rate_n_per_s = 1e9};
  const auto limited = limit_force(Vec3{30.0, 40.0, 0.0}, Vec3::Zero(), limits, 1e-3);
  CHECK(limited.force_n.isApprox(Vec3{3.0, 4.0, 0.0}));
}
TEST_CASE("a force that is not a number becomes zero force", "[core][force_limiter]") {
  const ForceLimits limits{.max_force_n = 5.0, .max_force_rate_n_per_s = 1e9};
  const auto limited = limit_force(Vec3{std::numeric_limits<double>::quiet_NaN(), 0, 0},
                                   Vec3{1, 1, 1}, limits, 1e-3);
  CHECK(limited.force_n == Vec3::Zero());
  CHECK(limited.was_changed);
}
TEST_CASE("a force within the limits is left to the last bit", "[core][force_limiter]") {
  const ForceLimits limits{.max_force_n = 5.0, .max_force_rate_n_per_s = 1e3};
  const Vec3 wanted{0.1, 0.7, -0.3};
  const auto limited = limit_force(wanted, Vec3{0.3, 0.1, 0.0}, limits, 1e-3);
  CHECK(limited.force_n == wanted);
  CHECK_FALSE(limited.was_changed);
}
TEST_CASE("a force never changes faster than its limit", "[core][force_limiter]") {
  const ForceLimits limits{.max_force_n = 5.0, .max_force_rate_n_per_s = 1e3};
  const auto limited = limit_force(Vec3{0, 4, 0}, Vec3{0, 1, 0}, limits, 1e-3);
  CHECK(limited.force_n.isApprox(Vec3{0, 2, 0}));
  CHECK(limited.was_changed);
}
