#include "runner/recordings/sinusoid_law.hpp"

#include <cmath>
#include <numbers>

#include "support/catch.hpp"
using namespace tapstudy;

TEST_CASE("sensors of one impact are one tap, and each has an amplitude of its own",
          "[runner][identify]") {
  runner::TapIdentification found;
  for (int impact = 1; impact <= 3; ++impact) {
    for (const std::string channel : {"tip", "nail"}) {
      runner::IdentifiedTap tap;
      tap.impact = impact;
      tap.channel = channel;
      tap.speed_m_s = 0.1 * impact;
      tap.sinusoid = analysis::FittedSinusoid{};
      tap.sinusoid->amplitude = (channel == "tip" ? 50.0 : 10.0) * *tap.speed_m_s;
      tap.sinusoid->decay_per_s = 118.0 + 2.0 * impact;
      tap.sinusoid->frequency_hz = 180.0;
      tap.sinusoid->explained = 1.0;
      found.taps.push_back(tap);
    }
  }
  const auto both = runner::sinusoid_law(found, {});
  std::erase_if(found.taps, [](const auto& tap) { return tap.channel == "nail"; });
  const auto tip = runner::sinusoid_law(found, {});
  CHECK(both->decay_per_s.interval.high == Approx(tip->decay_per_s.interval.high));
  CHECK_FALSE(both->amplitude_per_speed);
  CHECK(tip->amplitude_per_speed->value == Approx(50.0));
}

TEST_CASE("one motion of a surface is one force on the finger, whichever sensor measured it",
          "[runner][identify]") {
  const core::Finger finger{0.058, 300.0, 3.0};
  constexpr double decay_per_s = 20.0;
  constexpr double frequency_hz = 100.0;
  constexpr double metres_per_speed = 3e-4;
  const double omega = std::hypot(decay_per_s, 2.0 * std::numbers::pi * frequency_hz);
  const auto amplitude_n_s_per_m = [&](analysis::Quantity quantity, double per_metre) {
    runner::TapIdentification found;
    found.question.quantity = quantity;
    for (const double speed_m_s : {0.2, 0.4}) {
      runner::IdentifiedTap tap;
      tap.speed_m_s = speed_m_s;
      tap.sinusoid = analysis::FittedSinusoid{};
      tap.sinusoid->amplitude = metres_per_speed * per_metre * speed_m_s;
      tap.sinusoid->decay_per_s = decay_per_s;
      tap.sinusoid->frequency_hz = frequency_hz;
      tap.sinusoid->explained = 1.0;
      found.taps.push_back(tap);
    }
    return *runner::sinusoid_law(found, finger)->amplitude_n_s_per_m;
  };
  // |k + s b| at s = -20 + 2 pi 100 i
  const double expected =
      metres_per_speed * std::hypot(300.0 - 3.0 * decay_per_s, 3.0 * 200.0 * std::numbers::pi);
  CHECK(amplitude_n_s_per_m(analysis::Quantity::displacement, 1.0) ==
        Approx(expected).epsilon(1e-9));
  CHECK(amplitude_n_s_per_m(analysis::Quantity::velocity, omega) == Approx(expected).epsilon(1e-9));
  CHECK(amplitude_n_s_per_m(analysis::Quantity::acceleration, omega * omega) ==
        Approx(expected).epsilon(1e-9));
}
