// What was planted comes back inside its stated 95 % interval about 95 times in 100.
#include <algorithm>
#include <cmath>

#include "analysis/modal_identification/repeated_modes.hpp"
#include "analysis/recordings/taps.hpp"
#include "analysis/statistics/distributions.hpp"
#include "support/catch.hpp"
#include "support/synthetic_taps.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using testing::PlantedMode;

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
        identify_modes({recording.rate_hz, all.segment(begin, end - begin)}, {{20.0, 400.0}}));
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
          "[analysis][modal_identification][slow]") {
  const double signal_to_noise_db = GENERATE(40.0, 20.0, 10.0);
  check_holds(std::to_string(signal_to_noise_db) + " dB",
              coverage_of(signal_to_noise_db, 60, leave));
}

TEST_CASE("hum of the mains, clipped samples and a second tap soon after leave the intervals true",
          "[analysis][modal_identification][slow]") {
  check_holds("hum", coverage_of(30.0, 40, add_hum));
  check_holds("clipped", coverage_of(30.0, 40, clip));
  check_holds("two taps", coverage_of(30.0, 30, leave, {0.4, 0.55}));
}
