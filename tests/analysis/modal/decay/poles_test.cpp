// Natural frequencies and damping ratios of a free decay, by both methods and by SciPy.
#include <algorithm>
#include <cmath>

#include "analysis/modal/decay/decay_model.hpp"
#include "analysis/modal/decay/pole_estimation.hpp"
#include "analysis/modal/modes/repeated_modes.hpp"
#include "analysis/modal/modes/tap_modes.hpp"
#include "analysis/modal/recording/taps.hpp"
#include "analysis/statistics/distributions.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/reference_programs.hpp"
#include "support/synthetic_taps.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using testing::PlantedMode;

namespace {
const Band band{20.0, 600.0};
const std::vector<PlantedMode> planted_modes{{{62.0, 0.03}, 1.0, -1.5},
                                             {{118.0, 0.2}, 0.7, 0.3},
                                             {{124.0, 0.015}, 0.6, -1.2},
                                             {{431.0, 0.02}, 0.5, 2.0}};

bool has(const std::vector<Pole>& poles, const Pole& pole, double tolerance) {
  return std::ranges::any_of(poles, [&](const Pole& one) {
    return std::abs(one.frequency_hz / pole.frequency_hz - 1.0) < tolerance &&
           std::abs(one.damping_ratio - pole.damping_ratio) < tolerance;
  });
}

const TapMode* mode_near(const TapModes& tap, double frequency_hz) {
  const auto nearest = std::ranges::min_element(tap.modes, {}, [&](const TapMode& mode) {
    return std::abs(mode.fitted.pole.frequency_hz - frequency_hz);
  });
  return nearest == tap.modes.end() ? nullptr : &*nearest;
}

int agreed_in(const TapModes& tap) {
  return static_cast<int>(std::ranges::count(tap.modes, Standing::agreed, &TapMode::standing));
}
}  // namespace

TEST_CASE("without noise both methods find the poles, wherever the decay is cut off",
          "[analysis][modal]") {
  const double duration_s = GENERATE(0.1, 0.37, 1.0);
  const FreeDecay decay = testing::planted_decay(planted_modes, 4000.0, duration_s);
  const auto orders = matrix_pencil(decay, band, 8).orders;
  const auto by_rational_fit =
      vector_fitting(band_spectrum(decay, band), static_cast<int>(planted_modes.size()));
  REQUIRE(orders.back().order == 8);
  for (const PlantedMode& mode : planted_modes) {
    INFO(duration_s << " s, " << mode.pole.frequency_hz << " Hz");
    CHECK(has(orders.back().poles, mode.pole, 1e-4));
    CHECK(has(by_rational_fit, mode.pole, 1e-6));
  }
}

TEST_CASE("filtering and decimating a decay leaves its poles", "[analysis][modal]") {
  const FreeDecay decay = testing::planted_decay(planted_modes, 48000.0, 0.4);
  const FreeDecay slow = decimated(decay, band.high_hz);
  CHECK(slow.rate_hz >= 4.0 * band.high_hz);
  CHECK(slow.rate_hz < 5.0 * band.high_hz);
  for (const PlantedMode& mode : planted_modes) {
    CHECK(has(matrix_pencil(decay, band, 8).orders.back().poles, mode.pole, 1e-4));
  }
}

TEST_CASE("the transform of a cut exponential and its slopes are those of the sum",
          "[analysis][modal]") {
  const double rate_hz = 1000.0;
  // on a bin, where the closed form divides by 0; near one; damped
  const Pole pole = GENERATE(Pole{50.0, 0.0}, Pole{50.0, 1e-9}, Pole{77.7, 0.05});
  FreeDecay decay = testing::planted_decay({{pole, 1.7, 0.4}}, rate_hz, 0.2);
  const BandSpectrum spectrum = band_spectrum(decay, {20.0, 200.0});
  const std::complex<double> c = std::polar(1.7, 0.4);
  const auto transform = [&](const std::complex<double>& log_z) {
    const CutExponential both = cut_exponential(log_z, spectrum);
    const std::complex<double> j{0.0, 1.0};
    return Eigen::VectorXcd{c.real() * both.plus + j * c.imag() * both.minus};
  };
  const std::complex<double> log_z = log_of(pole, rate_hz);
  CHECK((transform(log_z) - spectrum.values).norm() < 1e-9 * spectrum.values.norm());
  const double step = 1e-6;
  const CutExponential slope = cut_exponential_slope(c, log_z, spectrum);
  const Eigen::VectorXcd along_real =
      (transform(log_z + step) - transform(log_z - step)) / (2.0 * step);
  const std::complex<double> up{0.0, step};
  const Eigen::VectorXcd along_imaginary =
      (transform(log_z + up) - transform(log_z - up)) / std::complex<double>{0.0, 2.0 * step};
  CHECK((along_real - slope.plus).norm() < 1e-5 * slope.plus.norm());
  CHECK((along_imaginary - slope.minus).norm() < 1e-5 * slope.minus.norm());
}

TEST_CASE("modes of a system that SciPy simulates are the eigenvalues that NumPy finds",
          "[analysis][modal]") {
  const auto numbers = testing::python_numbers(R"(
from scipy import signal, linalg
rng = np.random.default_rng(3)
M = np.diag([1.0, 1.5, 0.8])
K = 1e6 * np.array([[0.5, -0.2, 0.0], [-0.2, 0.9, -0.4], [0.0, -0.4, 1.1]])
C = 8.0 * M + 3e-5 * K
A = np.block([[np.zeros((3, 3)), np.eye(3)], [-linalg.solve(M, K), -linalg.solve(M, C)]])
s = np.linalg.eigvals(A)
s = s[s.imag > 0]
s = s[np.argsort(abs(s))]
out(abs(s) / 2 / np.pi, -s.real / abs(s))
B = np.vstack([np.zeros((3, 1)), linalg.solve(M, np.array([[1.0], [0.3], [0.6]]))])
t = np.arange(1200) / 2000.0
t, y = signal.impulse((A, B, np.array([[1.0, 0.5, 0.4, 0, 0, 0]]), 0), T=t)
out(y + 1e-3 * np.std(y) * rng.normal(size=len(y)))
)");
  REQUIRE(numbers.size() == 1206);
  const FreeDecay decay{2000.0, Eigen::Map<const Eigen::VectorXd>{numbers.data() + 6, 1200}};
  const TapModes tap = identify_modes(decay, {20.0, 400.0});
  REQUIRE(agreed_in(tap) == 3);
  for (std::size_t k = 0; k < 3; ++k) {
    const TapMode* const mode = mode_near(tap, numbers[k]);
    INFO(numbers[k] << " Hz, ratio " << numbers[3 + k]);
    CHECK(std::abs(mode->fitted.pole.frequency_hz - numbers[k]) <
          4.0 * mode->fitted.frequency_error_hz);
    CHECK(std::abs(mode->fitted.pole.damping_ratio - numbers[3 + k]) <
          4.0 * mode->fitted.ratio_error);
    CHECK(mode->fitted.frequency_error_hz < 0.01);
  }
}

TEST_CASE("standard errors are those of the Cramer-Rao bound, which NumPy computes from the decay",
          "[analysis][modal]") {
  FreeDecay decay = testing::planted_decay({{{100.0, 0.03}, 2.0, 0.5}}, 1000.0, 0.4);
  core::Rng rng{5};
  const double noise = testing::add_noise(decay, 30.0, rng);
  const DecayFit fit = fit_decay(band_spectrum(decay, {2.0, 499.0}), {{100.0, 0.03}});
  REQUIRE(fit.has_converged);
  CHECK(fit.noise == Approx(noise).epsilon(0.1));
  const FittedMode& mode = fit.modes.front();
  const std::string given = "f, z, A, p, sigma = " + std::to_string(mode.pole.frequency_hz) + ", " +
                            std::to_string(mode.pole.damping_ratio) + ", " +
                            std::to_string(mode.amplitude) + ", " + std::to_string(mode.phase_rad) +
                            ", " + std::to_string(fit.noise);
  const auto bound = testing::python_numbers(given + R"(
t = np.arange(400) / 1000.0
def y(x):
  w = 2 * np.pi * x[0]
  return x[2] * np.exp(-x[1] * w * t) * np.cos(w * np.sqrt(1 - x[1]**2) * t + x[3])
x = np.array([f, z, A, p])
J = np.array([(y(x + d) - y(x - d)) / 2e-6 for d in 1e-6 * np.eye(4)]).T
# unknown are also the mean, a drift and what stands in the first three samples
J = np.c_[J, np.ones(400), t, np.eye(400)[:, :3]]
out(np.sqrt(np.diag(np.linalg.inv(J.T @ J)))[:4] * sigma)
)");
  CHECK(mode.frequency_error_hz == Approx(bound[0]).epsilon(0.01));
  CHECK(mode.ratio_error == Approx(bound[1]).epsilon(0.01));
  CHECK(mode.amplitude_error == Approx(bound[2]).epsilon(0.01));
  CHECK(mode.phase_error_rad == Approx(bound[3]).epsilon(0.01));
}

TEST_CASE("two modes closer than their half-power bandwidth are told apart", "[analysis][modal]") {
  FreeDecay decay =
      testing::planted_decay({{{118.0, 0.03}, 1.0}, {{122.0, 0.03}, 0.8}}, 2000.0, 0.5);
  core::Rng rng{11};
  testing::add_noise(decay, 40.0, rng);
  const TapModes tap = identify_modes(decay, {20.0, 300.0});
  REQUIRE(agreed_in(tap) == 2);
  CHECK(tap.modes[0].fitted.pole.frequency_hz == Approx(118.0).margin(0.2));
  CHECK(tap.modes[1].fitted.pole.frequency_hz == Approx(122.0).margin(0.2));
}

TEST_CASE("noise has no agreed mode", "[analysis][modal]") {
  core::Rng rng{2};
  for (int i = 0; i < 20; ++i) {
    FreeDecay noise{2000.0, Eigen::VectorXd(800)};
    for (double& sample : noise.samples) {
      sample = rng.normal();
    }
    CHECK(agreed_in(identify_modes(noise, {20.0, 400.0})) == 0);
  }
}

TEST_CASE("an undamped line is no mode, and at the mains it is called hum", "[analysis][modal]") {
  using Line = std::tuple<double, double, std::string>;
  // the last falls a little, significantly, but by no more than a tenth in the whole tap
  const auto [line_hz, ratio, words] = GENERATE(values<Line>({{50.0, 0.0, "50 Hz hum"},
                                                              {150.1, 0.0, "3 times 50 Hz"},
                                                              {60.0, 0.0, "60 Hz hum"},
                                                              {73.0, 0.0, "steady tone"},
                                                              {73.0, 0.0005, "steady tone"}}));
  FreeDecay decay =
      testing::planted_decay({{{90.0, 0.03}, 1.0}, {{line_hz, ratio}, 0.3}}, 2000.0, 0.5);
  core::Rng rng{3};
  testing::add_noise(decay, ratio > 0.0 ? 60.0 : 30.0, rng);
  const TapModes tap = identify_modes(decay, {20.0, 300.0});
  const TapMode* const line = mode_near(tap, line_hz);
  REQUIRE(line != nullptr);
  CHECK(line->standing == Standing::line);
  CHECK_THAT(line->why, Contains(words));
  CHECK(mode_near(tap, 90.0)->standing == Standing::agreed);
}

TEST_CASE("a mode whose tap is over before it has fallen by half is a mode, not a steady tone",
          "[analysis][modal]") {
  FreeDecay decay =
      testing::planted_decay({{{62.0, 0.004}, 1.0}, {{118.0, 0.003}, 0.7}}, 4000.0, 0.22);
  core::Rng rng{5};
  testing::add_noise(decay, 40.0, rng);
  const TapModes tap = identify_modes(decay, {20.0, 400.0});
  for (const double frequency_hz : {62.0, 118.0}) {
    const TapMode* const mode = mode_near(tap, frequency_hz);
    REQUIRE(mode != nullptr);
    CHECK(mode->standing == Standing::agreed);
  }
}

TEST_CASE("a pole that does not last over the orders is not stable", "[analysis][modal]") {
  std::vector<PolesOfOrder> orders;
  for (int order = 2; order <= 20; order += 2) {
    std::vector<Pole> poles{{100.0, 0.02}};
    if (order <= 2 * min_stable_orders - 2) {
      poles.push_back({200.0, 0.02});  // one order too few
    }
    poles.push_back({300.0 + 5.0 * order, 0.02});           // moves by more than 1 %
    poles.push_back({500.0, 0.02 * std::pow(1.2, order)});  // its damping by more than 10 %
    orders.push_back({order, poles});
  }
  const auto stable = stable_poles(orders);
  REQUIRE(stable.size() == 1);
  CHECK(stable.front().pole.frequency_hz == 100.0);
  CHECK(stable.front().orders == 10);
}

TEST_CASE("a decay that is too short for the band is refused with the length it takes",
          "[analysis][modal]") {
  const FreeDecay decay = testing::planted_decay(planted_modes, 4000.0, 0.01);
  CHECK_THROWS_WITH(identify_modes(decay, band), Contains("too short") && Contains("at least"));
  CHECK_THROWS_AS(identify_modes(decay, band), core::InvalidInput);
}

TEST_CASE("a mode at a harmonic of the mains is no hum where the sensor is silent at rest",
          "[analysis][modal]") {
  core::Rng rng{3};
  // it falls by a third
  FreeDecay decay =
      testing::planted_decay({{{1000.0, 3e-4}, 1.0}, {{700.0, 0.01}, 0.5}}, 8000.0, 0.2);
  const double noise = testing::add_noise(decay, 40.0, rng);
  const auto rest_of = [&](double hum) {
    FreeDecay rest = testing::planted_decay({{{1000.0, 0.0}, hum}}, 8000.0, 0.3);
    for (double& sample : rest.samples) {
      sample += noise * rng.normal();
    }
    return rest;
  };
  const auto standing_of = [&](const FreeDecay& rest) {
    const TapModes tap = identify_modes(decay, {500.0, 1500.0}, rest);
    return mode_near(tap, 1000.0)->standing;
  };
  CHECK(standing_of(rest_of(0.0)) == Standing::agreed);
  CHECK(standing_of(rest_of(1.0)) == Standing::line);
  CHECK(standing_of({}) == Standing::line);  // nobody knows
  FreeDecay steady =
      testing::planted_decay({{{1000.0, 0.0}, 1.0}, {{700.0, 0.01}, 0.5}}, 8000.0, 0.2);
  testing::add_noise(steady, 40.0, rng);
  const TapModes tap = identify_modes(steady, {500.0, 1500.0}, rest_of(0.0));
  CHECK(mode_near(tap, 1000.0)->standing == Standing::line);  // begun by whatever
}

TEST_CASE("hum beside a mode falsifies its damping until another tap tells of it",
          "[analysis][modal]") {
  const std::vector<PlantedMode> with_hum{{{48.3, 0.055}, 1.0}, {{50.0, 0.0}, 0.03, 0.7}};
  // too short a tap to tell the two apart
  FreeDecay decay = testing::planted_decay(with_hum, 4000.0, 0.12);
  core::Rng rng{6};
  testing::add_noise(decay, 35.0, rng);
  FreeDecay long_decay = testing::planted_decay(with_hum, 4000.0, 1.0);
  testing::add_noise(long_decay, 40.0, rng);
  const TapModes alone = identify_modes(decay, {20.0, 200.0});
  const std::vector<TapModes> taps{alone, identify_modes(long_decay, {20.0, 200.0})};
  REQUIRE(alone.modes.size() == 1);
  REQUIRE(taps[1].modes.size() == 2);
  CHECK(missed_lines(taps[1], taps).empty());
  const std::vector<double> lines_hz = missed_lines(alone, taps);
  REQUIRE(lines_hz.size() == 1);
  CHECK(lines_hz.front() == Approx(50.0).margin(0.05));
  const TapModes told = with_lines(alone, decay, {20.0, 200.0}, lines_hz);
  REQUIRE(told.modes.size() == 1);
  const FittedMode& mode = told.modes.front().fitted;
  CHECK(std::abs(mode.pole.damping_ratio - 0.055) < 3.0 * mode.ratio_error);
  CHECK(std::abs(alone.modes.front().fitted.pole.damping_ratio - 0.055) >
        2.0 * std::abs(mode.pole.damping_ratio - 0.055));
}

// What was planted comes back inside its stated 95 % interval about 95 times in 100.
namespace {
constexpr double rate_hz = 3000.0;
constexpr double recorded_s = 1.4;
const std::vector<PlantedMode> covered_modes{
    {{62.0, 0.03}, 1.0}, {{118.0, 0.02}, 0.7}, {{133.0, 0.015}, 0.6}, {{260.0, 0.03}, 0.8}};

// The ratio of the mean power over the first 0.2 s to that of the noise.
double noise_for(const std::vector<PlantedMode>& modes, double signal_to_noise_db) {
  return testing::noise_for(testing::planted_decay(modes, rate_hz, 0.2), signal_to_noise_db);
}

std::vector<TapModes> modes_of(const Recording& recording) {
  const Eigen::Map<const Eigen::VectorXd> all{recording.samples.data(),
                                              static_cast<Eigen::Index>(recording.samples.size())};
  std::vector<TapModes> taps;
  for (const Tap& tap : find_taps(recording, {}).taps) {
    const auto begin = static_cast<Eigen::Index>(tap.begin);
    const auto end = static_cast<Eigen::Index>(tap.end);
    taps.push_back(
        identify_modes({recording.rate_hz, all.segment(begin, end - begin)}, {20.0, 400.0}));
  }
  return taps;
}

struct Coverage {
  int found{};  // of all that were planted
  int planted{};
  int frequencies{};  // inside their interval
  int ratios{};
  int spurious{};  // agreed, but not planted
};

bool is_inside(double value, double error, double truth, double degrees_of_freedom) {
  return std::abs(value - truth) <= t_quantile(0.975, degrees_of_freedom) * error;
}

void count(const TapModes& tap, Coverage& coverage) {
  for (const TapMode& mode : tap.modes) {
    if (mode.standing != Standing::agreed) {
      continue;
    }
    const Pole& pole = mode.fitted.pole;
    const auto nearest =
        std::ranges::min_element(covered_modes, {}, [&](const PlantedMode& planted) {
          return std::abs(planted.pole.frequency_hz - pole.frequency_hz);
        });
    const Pole& truth = nearest->pole;
    if (std::abs(truth.frequency_hz - pole.frequency_hz) > 0.05 * truth.frequency_hz) {
      ++coverage.spurious;
      continue;
    }
    ++coverage.found;
    const double freedom = tap.fit.degrees_of_freedom;
    coverage.frequencies +=
        is_inside(pole.frequency_hz, mode.fitted.frequency_error_hz, truth.frequency_hz, freedom)
            ? 1
            : 0;
    coverage.ratios +=
        is_inside(pole.damping_ratio, mode.fitted.ratio_error, truth.damping_ratio, freedom) ? 1
                                                                                             : 0;
  }
}

void leave(Recording& /*recording*/) {}

Coverage coverage_of(double signal_to_noise_db, int recordings, void (*change)(Recording&),
                     const std::vector<double>& taps_s = {0.4}) {
  Coverage coverage;
  for (int i = 0; i < recordings; ++i) {
    Recording recording = testing::planted_recording(
        covered_modes, taps_s, rate_hz, recorded_s, noise_for(covered_modes, signal_to_noise_db),
        static_cast<std::uint64_t>(1000 * signal_to_noise_db + i));
    change(recording);
    coverage.planted += static_cast<int>(covered_modes.size() * taps_s.size());
    for (const TapModes& tap : modes_of(recording)) {
      count(tap, coverage);
    }
  }
  return coverage;
}

// Counts of intervals that hold are binomial; 1 in 1000 would be further off, on either side.
bool is_about_95_percent(int inside, int of_all) {
  const double expected = 0.95 * of_all;
  const double spread = std::sqrt(of_all * 0.95 * 0.05);
  return std::abs(inside - expected) <= 3.3 * spread;
}

void check_holds(const std::string& name, const Coverage& coverage) {
  INFO(name << ": " << coverage.found << " of " << coverage.planted << ", " << coverage.frequencies
            << " frequencies, " << coverage.ratios << " ratios inside, " << coverage.spurious
            << " spurious");
  CHECK(coverage.found >= 0.9 * coverage.planted);
  CHECK(coverage.spurious == 0);
  CHECK(is_about_95_percent(coverage.frequencies, coverage.found));
  CHECK(is_about_95_percent(coverage.ratios, coverage.found));
}

void add_hum(Recording& recording) {
  for (std::size_t n = 0; n < recording.samples.size(); ++n) {
    recording.samples[n] +=
        0.1 * std::sin(2.0 * std::numbers::pi * 50.0 * static_cast<double>(n) / rate_hz + 1.0);
  }
}

void clip(Recording& recording) {
  for (double& sample : recording.samples) {
    sample = std::clamp(sample, -1.2, 1.2);
  }
}
}  // namespace

TEST_CASE("frequencies and damping ratios lie inside 95 % of their intervals at any noise",
          "[analysis][modal][slow]") {
  const double signal_to_noise_db = GENERATE(40.0, 20.0, 10.0);
  check_holds(std::to_string(signal_to_noise_db) + " dB",
              coverage_of(signal_to_noise_db, 60, leave));
}

TEST_CASE("hum of the mains, clipped samples and a second tap soon after leave the intervals true",
          "[analysis][modal][slow]") {
  check_holds("hum", coverage_of(30.0, 40, add_hum));
  check_holds("clipped", coverage_of(30.0, 40, clip));
  check_holds("two taps", coverage_of(30.0, 30, leave, {0.4, 0.55}));
}
