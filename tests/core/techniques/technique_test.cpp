#include "core/techniques/technique.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/techniques/compensated.hpp"
#include "core/techniques/resampled.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
using namespace tapstudy::core;

TEST_CASE("at rest on a heavy plate every technique renders the contact spring's force",
          "[core][technique]") {
  RenderSettings settings;
  settings.sinusoid.amplitude_n_s_per_m = 3.0;
  settings.recorded_taps = std::make_shared<const RecordedTaps>(
      RecordedTaps{1.0 / settings.dt_s, {{{0.0, 0.0}, 0.3, {0.1, -0.1}}}});
  const VibratingPlate heavy = tapstudy::testing::uniform_plate(
      Eigen::ArrayXd::Constant(1, 200.0), 0.1, Eigen::ArrayXd::Constant(1, 1e-3));
  for (const double finger_n_per_m : {30.0, 300.0, 30'000.0}) {
    settings.finger.stiffness_n_per_m = finger_n_per_m;
    for (const Technique& technique : techniques()) {
      TapRenderer renderer = make_renderer(technique, settings, PlateFace{0.3, 0.3}, &heavy);
      renderer.tick({{0.0, 0.0, 1e-4}, {0.0, 0.0, -0.3}});
      double force_n = 0.0;
      for (int tick = 0; tick < 10'000; ++tick) {
        force_n = renderer.tick({{0.0, 0.0, -0.001}, Vec3::Zero()}).force_n.z();
      }
      INFO(technique.name << " " << finger_n_per_m);
      CHECK(force_n == Approx(3.0).epsilon(1e-6));
    }
  }
}

// What a device does not render is commanded beforehand.
using namespace tapstudy;

namespace {
constexpr double rate_hz = 1000.0;

// A device with a mass: a first-order low pass, of minimum phase.
struct LowPass {
  double pole{0.6};
  double gain(double frequency_hz) const {
    const double angle = 2.0 * std::numbers::pi * frequency_hz / rate_hz;
    return (1.0 - pole) / std::abs(1.0 - pole * std::polar(1.0, -angle));
  }
  std::vector<double> rendered(const std::vector<double>& commanded) const {
    std::vector<double> force;
    double last = 0.0;
    for (const double one : commanded) {
      last = pole * last + (1.0 - pole) * one;
      force.push_back(last);
    }
    return force;
  }
  core::DeviceResponse measured(double max_boost) const {
    core::DeviceResponse response{{}, max_boost};
    for (double frequency_hz = 1.0; frequency_hz < 500.0; frequency_hz += 1.0) {
      response.points.push_back({frequency_hz, gain(frequency_hz)});
    }
    return response;
  }
};

std::vector<double> tap() {
  std::vector<double> force_n;
  for (int i = 0; i < 100; ++i) {
    force_n.push_back(std::exp(-0.03 * i) * std::sin(2.0 * std::numbers::pi * 0.12 * i));
  }
  return force_n;
}
double largest_difference(const std::vector<double>& one, const std::vector<double>& other) {
  double largest = 0.0;
  for (std::size_t i = 0; i < std::max(one.size(), other.size()); ++i) {
    largest = std::max(
        largest, std::abs((i < one.size() ? one[i] : 0.0) - (i < other.size() ? other[i] : 0.0)));
  }
  return largest;
}
}  // namespace

TEST_CASE("a device that damps high frequencies renders what was recorded", "[core][techniques]") {
  const LowPass device;
  const auto commanded = core::compensated(tap(), device.measured(10.0), rate_hz);
  CHECK(largest_difference(device.rendered(tap()), tap()) > 0.2);
  CHECK(largest_difference(device.rendered(commanded), tap()) < 0.005);
}

TEST_CASE("a device that renders as commanded is commanded the recording", "[core][techniques]") {
  CHECK(largest_difference(core::compensated(tap(), {{{100.0, 1.0}}}, rate_hz), tap()) < 1e-12);
  std::vector<double> doubled = tap();
  std::ranges::transform(doubled, doubled.begin(), [](double x) { return 2.0 * x; });
  CHECK(largest_difference(core::compensated(tap(), {{{100.0, 0.5}}}, rate_hz), doubled) < 1e-12);
}

TEST_CASE("no frequency is amplified by more than is allowed", "[core][techniques]") {
  const auto impulse = core::compensated({1.0}, LowPass{}.measured(2.0), rate_hz);
  for (const double frequency_hz : {10.0, 100.0, 200.0, 400.0, 499.0}) {
    std::complex<double> response;
    for (std::size_t i = 0; i < impulse.size(); ++i) {
      response += impulse[i] * std::polar(1.0, -2.0 * std::numbers::pi * frequency_hz *
                                                   static_cast<double>(i) / rate_hz);
    }
    CAPTURE(frequency_hz);
    CHECK(std::abs(response) ==
          Approx(std::min(2.0, 1.0 / LowPass{}.gain(frequency_hz))).epsilon(0.01));
  }
}

TEST_CASE("nothing is commanded before the impact, and in the end nothing", "[core][techniques]") {
  std::vector<double> late(30, 0.0);
  const auto signal = tap();
  late.insert(late.end(), signal.begin(), signal.end());
  const auto commanded = core::compensated(late, LowPass{}.measured(10.0), rate_hz);
  CHECK(std::abs(*std::max_element(commanded.begin(), commanded.begin() + 30,
                                   [](double a, double b) { return std::abs(a) < std::abs(b); })) <
        1e-9);
  CHECK(commanded.size() < late.size() + 100);
}

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
