#include "core/tick/decaying_sinusoid.hpp"

#include <cmath>
#include <numbers>

#include "support/catch.hpp"

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
  DecayingSinusoid sinusoid{settings_by_place()};
  Contact contact;
  contact.god_object_m = {x_m, 0.07, 0.0};
  sinusoid.touch(contact);
  sinusoid.impact(struck_m_s);
  sinusoid.advance();
  sinusoid.advance();
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
  DecayingSinusoid sinusoid{settings_by_place()};
  Contact contact;
  contact.god_object_m = {-0.2, 0.0, 0.0};
  sinusoid.touch(contact);
  sinusoid.impact(struck_m_s);
  contact.god_object_m.x() = 0.2;
  sinusoid.touch(contact);
  sinusoid.advance();
  sinusoid.advance();
  ForceParts parts;
  sinusoid.add_to(parts);
  CHECK(parts.sinusoid_n == Approx(expected_n(3.0, 100.0)));
}
