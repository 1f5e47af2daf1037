#include "core/tick/impact_transients.hpp"

#include <cmath>
#include <numbers>

#include "core/techniques/technique.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
using namespace tapstudy::core;

namespace {
constexpr double struck_m_s = 0.2;
RenderSettings settings_by_place() {
  RenderSettings settings;
  settings.dt_s = 1e-3;
  settings.sinusoid = {3.0, 600.0, 100.0, {}};
  settings.sinusoid.by_place = SinusoidShape::ByPlace{{-0.2, 0.0}, {0.2, 0.0}, 3.0, 0.5};
  return settings;
}
// A e^(-B t) sin(2 pi f t), two milliseconds after an impact at x.
double force_n(double x_m) {
  DecayingSinusoid sinusoid{settings_by_place().sinusoid, settings_by_place().dt_s};
  Contact contact;
  contact.god_object_m = {x_m, 0.07, 0.0};
  sinusoid.touch(contact);
  sinusoid.impact(struck_m_s);
  sinusoid.advance(1);
  sinusoid.advance(1);
  ForceParts parts;
  sinusoid.add_to(parts);
  return parts.sinusoid_n;
}
double expected_n(double amplitude_n_s_per_m, double frequency_hz) {
  const double t_s = 2e-3;
  return amplitude_n_s_per_m * struck_m_s * std::exp(-600.0 * t_s) *
         std::sin(2.0 * std::numbers::pi * frequency_hz * t_s);
}
}  // namespace

TEST_CASE("a sinusoid by place changes amplitude and frequency in proportion to the way",
          "[core][tick]") {
  CHECK(force_n(-0.2) == Approx(expected_n(3.0, 100.0)));
  CHECK(force_n(0.0) == Approx(expected_n(6.0, 75.0)));
  CHECK(force_n(0.2) == Approx(expected_n(9.0, 50.0)));
  CHECK(force_n(-0.3) == Approx(force_n(-0.2)));
  CHECK(force_n(0.3) == Approx(force_n(0.2)));
}

TEST_CASE("a sinusoid that rings keeps the frequency of its impact", "[core][tick]") {
  DecayingSinusoid sinusoid{settings_by_place().sinusoid, settings_by_place().dt_s};
  Contact contact;
  contact.god_object_m = {-0.2, 0.0, 0.0};
  sinusoid.touch(contact);
  sinusoid.impact(struck_m_s);
  contact.god_object_m.x() = 0.2;
  sinusoid.touch(contact);
  sinusoid.advance(1);
  sinusoid.advance(1);
  ForceParts parts;
  sinusoid.add_to(parts);
  CHECK(parts.sinusoid_n == Approx(expected_n(3.0, 100.0)));
}

using namespace tapstudy;

namespace {
const core::SinusoidShape shape{2.0, 40.0, 60.0};

std::vector<double> sampled_n(double rate_hz, double speed_m_s, double seconds) {
  std::vector<double> force_n;
  for (int i = 0; i < static_cast<int>(seconds * rate_hz); ++i) {
    const double t_s = i / rate_hz;
    force_n.push_back(shape.amplitude_n_s_per_m * speed_m_s * std::exp(-shape.decay_per_s * t_s) *
                      std::sin(2.0 * std::numbers::pi * shape.frequency_hz * t_s));
  }
  return force_n;
}
core::RenderSettings with_taps(double rate_hz, std::vector<core::RecordedTap> taps) {
  core::RenderSettings settings;
  settings.sinusoid = shape;
  settings.recorded_taps =
      std::make_shared<const core::RecordedTaps>(core::RecordedTaps{rate_hz, std::move(taps)});
  return settings;
}
std::unique_ptr<core::AddedForce> player(const core::RenderSettings& settings) {
  return core::recorded_transient.make(settings, nullptr);
}
double felt_n(const core::AddedForce& force) {
  core::ForceParts parts;
  force.add_to(parts);
  return parts.vibration_n;
}
void touch(core::AddedForce& force, double x_m, double y_m) {
  core::Contact contact;
  contact.god_object_m = {x_m, y_m, 0.0};
  force.touch(contact);
}
}  // namespace

TEST_CASE(
    "a recording of a decaying sinusoid is felt as the decaying sinusoid, at any rate and speed",
    "[core][tick][recorded]") {
  const double rate_hz = GENERATE(1000.0, 4000.0, 11025.0, 48000.0);
  const double speed_m_s = GENERATE(0.3, 0.6);
  CAPTURE(rate_hz, speed_m_s);
  const auto settings = with_taps(rate_hz, {{{0.0, 0.0}, 0.3, sampled_n(rate_hz, 0.3, 0.2)}});
  const auto recorded = player(settings);
  core::DecayingSinusoid sinusoid{settings.sinusoid, settings.dt_s};
  touch(*recorded, 0.0, 0.0);
  recorded->impact(speed_m_s);
  sinusoid.impact(speed_m_s);
  double felt_n2 = 0.0;
  double difference_n2 = 0.0;
  for (int tick = 0; tick < 190; ++tick) {
    core::ForceParts parts;
    sinusoid.add_to(parts);
    felt_n2 += std::pow(parts.sinusoid_n, 2);
    difference_n2 += std::pow(parts.sinusoid_n - felt_n(*recorded), 2);
    recorded->advance(1);
    sinusoid.advance(1);
  }
  // the sudden beginning has frequencies that the loop's rate cannot hold
  CHECK(std::sqrt(difference_n2 / felt_n2) < 0.025);
}

TEST_CASE("what a device is known to halve is commanded twice as strong",
          "[core][tick][recorded]") {
  core::RenderSettings settings =
      with_taps(1000.0, {{{0.0, 0.0}, 0.3, sampled_n(1000.0, 0.3, 0.1)}});
  const auto as_recorded = player(settings);
  settings.device_response =
      std::make_shared<const core::DeviceResponse>(core::DeviceResponse{{{100.0, 0.5}}});
  const auto commanded = player(settings);
  for (core::AddedForce* const force : {as_recorded.get(), commanded.get()}) {
    touch(*force, 0.0, 0.0);
    force->impact(0.3);
  }
  for (int tick = 0; tick < 90; ++tick) {
    CHECK(felt_n(*commanded) == Approx(2.0 * felt_n(*as_recorded)).margin(1e-9));
    as_recorded->advance(1);
    commanded->advance(1);
  }
}

TEST_CASE("of several recordings the nearest place is played, and there the nearest speed",
          "[core][tick][recorded]") {
  const auto constant = [](double x_m, double speed_m_s, double force_n) {
    return core::RecordedTap{{x_m, 0.0}, speed_m_s, {force_n, force_n}};
  };
  const auto settings = with_taps(
      1000.0, {constant(0.0, 0.1, 1.0), constant(0.0, 0.4, 2.0), constant(0.1, 0.1, 3.0)});
  const auto force = player(settings);
  const auto felt_after = [&](double x_m, double speed_m_s) {
    touch(*force, x_m, 0.02);
    force->impact(speed_m_s);
    return felt_n(*force);
  };
  CHECK(felt_after(0.04, 0.1) == Approx(1.0));
  CHECK(felt_after(0.04, 0.19) == Approx(1.9));  // ratios: 1.9 to 0.1, 2.1 to 0.4
  CHECK(felt_after(0.04, 0.21) == Approx(2.0 * 0.21 / 0.4));
  CHECK(felt_after(0.06, 0.4) == Approx(12.0));
}

TEST_CASE("a recording is silent before an impact, after its end and when it is reset",
          "[core][tick][recorded]") {
  const auto settings = with_taps(1000.0, {{{0.0, 0.0}, 1.0, {1.0, 2.0, 3.0}}});
  const auto force = player(settings);
  touch(*force, 0.0, 0.0);
  CHECK(felt_n(*force) == 0.0);
  force->impact(1.0);
  for (const double expected_n : {1.0, 2.0, 3.0, 0.0, 0.0}) {
    CHECK(felt_n(*force) == expected_n);
    force->advance(1);
  }
  force->impact(2.0);
  CHECK(felt_n(*force) == 2.0);
  force->advance(1);
  force->impact(1.0);  // from its beginning again
  CHECK(felt_n(*force) == 1.0);
  force->reset();
  CHECK(felt_n(*force) == 0.0);
}

TEST_CASE("playing a recording does not allocate", "[core][tick][recorded][realtime]") {
  const auto settings = with_taps(4000.0, {{{0.0, 0.0}, 0.3, sampled_n(4000.0, 0.3, 0.2)}});
  core::TapRenderer renderer = core::make_renderer(*core::find_technique("recorded"), settings,
                                                   core::PlateFace{0.1, 0.1}, nullptr);
  double largest_n = 0.0;
  const testing::AllocationCount allocations;
  for (int tick = 0; tick < 100; ++tick) {
    const double z_m = 0.01 - 3e-4 * tick;
    const auto rendered = renderer.tick({{0.0, 0.0, z_m}, {0.0, 0.0, -0.3}});
    largest_n = std::max(largest_n, std::abs(rendered.parts.vibration_n));
  }
  CHECK(allocations.count() == 0);
  CHECK(largest_n > 0.1);
}
