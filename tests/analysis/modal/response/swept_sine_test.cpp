#include "analysis/modal/response/swept_sine.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "support/catch.hpp"
using namespace tapstudy;

namespace {
constexpr double rate_hz = 8000.0;
constexpr analysis::SweptSine sweep{rate_hz, 40.0, 1000.0, 1.0, 3};
constexpr double pole = 0.9;

// A low pass of one pole, y_n = g (1 - a) x_n + a y_(n-1), some samples later.
std::vector<double> low_passed(const std::vector<double>& x, double gain, std::size_t later) {
  std::vector<double> y(x.size() + later + 800, 0.0);
  for (std::size_t i = 0; i + later < y.size(); ++i) {
    const double before = i + later == 0 ? 0.0 : y[i + later - 1];
    y[i + later] = gain * (1.0 - pole) * (i < x.size() ? x[i] : 0.0) + pole * before;
  }
  return y;
}
std::complex<double> low_pass_at(double frequency_hz) {
  return (1.0 - pole) /
         (1.0 - pole * std::polar(1.0, -2.0 * std::numbers::pi * frequency_hz / rate_hz));
}
std::vector<double> later_by(const std::vector<double>& x, std::size_t later) {
  std::vector<double> y(later, 0.0);
  y.insert(y.end(), x.begin(), x.end());
  return y;
}
}  // namespace

TEST_CASE("the response of a known filter is found from a sweep, whenever it is recorded",
          "[analysis][modal][actuator]") {
  const std::size_t later = GENERATE(0U, 777U);
  const double quadratic = GENERATE(0.0, 0.2);
  const std::vector<double> played = analysis::samples_of(sweep);
  std::vector<double> recorded = low_passed(played, 2.5, later);
  for (double& y : recorded) {
    y += quadratic * y * y;  // adds a harmonic and a mean, nothing at the sweep's frequency
  }
  const analysis::SweptResponse found =
      analysis::response_to(sweep, recorded, later_by(played, later), 25);
  REQUIRE(found.points.size() == 25);
  CHECK(found.points.front().frequency_hz == Approx(40.0));
  CHECK(found.points.back().frequency_hz == Approx(1000.0));
  CHECK(found.delay_s == Approx(static_cast<double>(later) / rate_hz));
  for (const analysis::ResponsePoint& point : found.points) {
    const std::complex<double> expected = 2.5 * low_pass_at(point.frequency_hz);
    CAPTURE(later, quadratic, point.frequency_hz);
    CHECK(point.gain == Approx(std::abs(expected)).epsilon(0.01));
    CHECK(point.phase_rad == Approx(std::arg(expected)).margin(0.01));
    CHECK(point.coherence > 0.999);
  }
}

TEST_CASE(
    "noise alone is coherent by chance only, and noise beside a response lowers its coherence",
    "[analysis][modal][actuator]") {
  const double gain = GENERATE(0.0, 1.0);
  std::vector<double> recorded = low_passed(analysis::samples_of(sweep), gain, 100);
  std::mt19937 random{3};
  std::normal_distribution<double> noise{0.0, 0.05};
  for (double& y : recorded) {
    y += noise(random);
  }
  double mean = 0.0;
  const analysis::SweptResponse found = analysis::response_to(sweep, recorded, {}, 50);
  for (const analysis::ResponsePoint& point : found.points) {
    CHECK(point.coherence >= 0.0);
    CHECK(point.coherence <= 1.0 + 1e-12);
    mean += point.coherence / 50.0;
  }
  CAPTURE(gain, mean);
  if (gain == 0.0) {
    CHECK(mean == Approx(1.0 / 3.0).margin(0.12));
  } else {
    CHECK(mean > 0.9);
    CHECK(mean < 0.9999);
  }
}

TEST_CASE("a recording that is shorter than the sweeps is refused, as is a sweep beyond the rate",
          "[analysis][modal][actuator]") {
  const std::vector<double> short_one(1000, 0.0);
  CHECK_THROWS_WITH(analysis::response_to(sweep, short_one, {}, 10), Contains("0.12 s long"));
  analysis::SweptSine high = sweep;
  high.to_hz = 3000.0;
  CHECK_THROWS_WITH(analysis::samples_of(high), Contains("half an octave beyond"));
  analysis::SweptSine brief = sweep;
  brief.seconds = 0.9;
  CHECK_THROWS_WITH(analysis::samples_of(brief), Contains("takes 1 s at least"));
}
