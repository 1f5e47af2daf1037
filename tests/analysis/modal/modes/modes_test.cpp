#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/modal/modes/assignment.hpp"
#include "analysis/modal/modes/close_modes.hpp"
#include "analysis/modal/modes/mode_shapes.hpp"
#include "analysis/modal/modes/model_matching.hpp"
#include "analysis/modal/modes/repeated_modes.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
#include "support/reference_programs.hpp"
#include "support/synthetic_taps.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
// That shows one agreed mode.
TapModes tap_of(double frequency_hz, double error_hz) {
  TapModes tap;
  FittedMode fitted;
  fitted.pole = {frequency_hz, 0.02};
  fitted.frequency_error_hz = error_hz;
  fitted.ratio_error = 1e-4;
  tap.modes.push_back({fitted, Standing::agreed, "", {}, 5});
  return tap;
}

double cost_of(const std::vector<std::size_t>& columns, const Eigen::MatrixXd& cost) {
  double sum = 0.0;
  for (std::size_t row = 0; row < columns.size(); ++row) {
    sum += cost(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(columns[row]));
  }
  return sum;
}
}  // namespace

TEST_CASE("the least cost of an assignment is SciPy's", "[analysis][modal]") {
  core::Rng rng{4};
  std::string script = "from scipy.optimize import linear_sum_assignment as f\n";
  std::vector<double> ours;
  for (int sample = 0; sample < 40; ++sample) {
    const Eigen::Index rows = 1 + rng.below(9);
    const Eigen::Index columns = rows + rng.below(6);
    Eigen::MatrixXd cost(rows, columns);
    std::string text;
    for (double& one : cost.reshaped<Eigen::RowMajor>()) {
      one = static_cast<double>(rng.below(20)) - 5.0;  // with ties
      text += fmt::format("{},", one);
    }
    script += fmt::format("c = np.array([{}]).reshape({}, {})\nout(c[f(c)].sum())\n", text, rows,
                          columns);
    ours.push_back(cost_of(least_cost_assignment(cost), cost));
  }
  CHECK(ours == testing::python_numbers(script));
}

TEST_CASE("shapes in proportion have an assurance of 1, orthogonal ones and none of 0",
          "[analysis][modal]") {
  const Eigen::Vector3d shape{1.0, -2.0, 0.5};
  CHECK(modal_assurance(shape, -3.0 * shape) == Approx(1.0).epsilon(1e-12));
  CHECK(modal_assurance(shape, Eigen::Vector3d{2.0, 1.0, 0.0}) == Approx(0.0).margin(1e-12));
  CHECK(modal_assurance(shape, Eigen::Vector3d::Zero()) == 0.0);
}

TEST_CASE("what channels say of one impact is one observation", "[analysis][modal]") {
  std::vector<TapModes> one_channel;
  std::vector<TapModes> two_channels;
  std::vector<int> impacts;
  int impact = 0;
  for (const double frequency_hz : {100.0, 100.2, 99.9, 100.1}) {
    one_channel.push_back(tap_of(frequency_hz, 0.01));
    ++impact;
    for (const double apart : {-0.05, 0.05}) {
      two_channels.push_back(tap_of(frequency_hz + apart, 0.01));
      impacts.push_back(impact);
    }
  }
  const auto one = modes_over_taps(one_channel).at(0).frequency_hz;
  const auto two = modes_over_taps(two_channels, impacts).at(0).frequency_hz;
  CHECK(two.value == Approx(one.value).epsilon(1e-12));
  CHECK(two.interval.low == Approx(one.interval.low).epsilon(1e-12));
  CHECK(modes_over_taps(two_channels).at(0).frequency_hz.interval.low > two.interval.low);
}

TEST_CASE("taps that differ as their errors say do not scatter, however unequal the errors",
          "[analysis][modal]") {
  const std::vector<double> errors_hz{0.01, 0.01, 0.01, 0.03, 0.03, 0.03, 0.1, 0.1};
  core::Rng rng{2};
  constexpr int recordings = 2000;
  int improbable = 0;
  for (int recording = 0; recording < recordings; ++recording) {
    std::vector<TapModes> taps;
    for (const double error_hz : errors_hz) {
      taps.push_back(tap_of(100.0 + error_hz * rng.normal(), error_hz));
    }
    improbable += modes_over_taps(taps).at(0).scatter_p.value() < 0.05 ? 1 : 0;
  }
  CHECK(improbable / static_cast<double>(recordings) == Approx(0.05).margin(0.02));
  // two modes, of which each tap shows the stronger one
  std::vector<TapModes> two;
  for (const double frequency_hz : {100.0, 100.0, 100.2, 100.0, 100.2}) {
    two.push_back(tap_of(frequency_hz, 0.01));
  }
  CHECK(modes_over_taps(two).at(0).scatter_p.value() < 1e-6);
  two.resize(2);
  CHECK_FALSE(modes_over_taps(two).at(0).scatter_p);  // of two it would say little
}

// Modes that one tap shows as one are told apart by several taps or sensors that see them in
// different proportions.
using testing::PlantedMode;

namespace {
constexpr double sampled_hz = 3000.0;
constexpr double ring_s = 1.0;
constexpr double low_hz = 118.0;
constexpr double ratio = 0.02;  // half-power bandwidth 4.7 Hz
const Band sought{20.0, 400.0};

// What one channel sees of the two close modes.
using Shares = std::pair<double, double>;

struct Channel {
  int impact{};
  std::vector<PlantedMode> modes;
};

std::vector<PlantedMode> ringing_with(const Shares& shares, const Pole& low, const Pole& high) {
  return {{{62.0, 0.03}, 1.0}, {low, shares.first}, {high, shares.second}, {{260.0, 0.03}, 0.8}};
}

// Six impacts at three places, each seen by both sensors.
std::vector<Channel> channels_of(const Pole& low, const Pole& high) {
  const std::vector<Shares> places{{0.7, 0.2}, {0.2, 0.7}, {0.6, -0.5}};
  const std::vector<Shares> sensors{{1.0, 0.3}, {0.4, -1.0}};
  std::vector<Channel> channels;
  for (int impact = 0; impact < 6; ++impact) {
    const Shares& place = places[static_cast<std::size_t>(impact) % places.size()];
    for (const Shares& sensor : sensors) {
      const Shares seen{place.first * sensor.first, place.second * sensor.second};
      channels.push_back({impact, ringing_with(seen, low, high)});
    }
  }
  return channels;
}

ModesOfTaps found_in(const std::vector<Channel>& channels, double signal_to_noise_db,
                     std::uint64_t seed) {
  core::Rng rng{seed};
  std::vector<FreeDecay> decays;
  std::vector<int> impacts;
  std::vector<TapModes> alone;
  for (const Channel& channel : channels) {
    const double noise = testing::noise_for(testing::planted_decay(channel.modes, sampled_hz, 0.2),
                                            signal_to_noise_db);
    FreeDecay decay = testing::planted_decay(channel.modes, sampled_hz, ring_s);
    for (double& sample : decay.samples) {
      sample += noise * rng.normal();
    }
    decays.push_back(decay);
    impacts.push_back(channel.impact);
    alone.push_back(identify_modes(decay, {sought}));
  }
  return resolve_close_modes(decays, impacts, sought, {alone, modes_over_taps(alone, impacts)});
}

std::vector<RepeatedMode> agreed_near(const ModesOfTaps& found, double frequency_hz) {
  std::vector<RepeatedMode> modes;
  std::ranges::copy_if(found.modes, std::back_inserter(modes), [&](const RepeatedMode& mode) {
    return mode.standing == Standing::agreed &&
           std::abs(mode.frequency_hz.value / frequency_hz - 1.0) < 0.06;
  });
  return modes;
}

bool contains(const Estimate& estimate, double value) {
  return estimate.interval.low <= value && value <= estimate.interval.high;
}

struct CloseCoverage {
  int told_apart{};
  int inside{};
};

CloseCoverage close_coverage_of(double apart_hz, double signal_to_noise_db, int recordings) {
  const std::vector<Pole> poles{{low_hz, ratio}, {low_hz + apart_hz, ratio}};
  CloseCoverage coverage;
  for (int i = 0; i < recordings; ++i) {
    const ModesOfTaps found = found_in(channels_of(poles[0], poles[1]), signal_to_noise_db,
                                       static_cast<std::uint64_t>(i));
    const std::vector<RepeatedMode> near = agreed_near(found, low_hz);
    if (near.size() != poles.size()) {
      continue;
    }
    ++coverage.told_apart;
    for (std::size_t k = 0; k < poles.size(); ++k) {
      coverage.inside += contains(near[k].frequency_hz, poles[k].frequency_hz) ? 1 : 0;
      coverage.inside += contains(near[k].damping_ratio, poles[k].damping_ratio) ? 1 : 0;
    }
  }
  return coverage;
}
}  // namespace

TEST_CASE("two modes within a fraction of their bandwidth come back inside their intervals",
          "[analysis][modal][slow]") {
  const auto [signal_to_noise_db, apart_hz] =
      GENERATE(table<double, double>({{40.0, 1.0}, {20.0, 1.0}, {10.0, 2.0}}));
  constexpr int recordings = 12;
  const CloseCoverage coverage = close_coverage_of(apart_hz, signal_to_noise_db, recordings);
  INFO(signal_to_noise_db << " dB, " << apart_hz << " Hz: told apart " << coverage.told_apart
                          << " times, inside " << coverage.inside);
  CHECK(coverage.told_apart >= 0.9 * recordings);
  const double expected = 0.95 * 4.0 * coverage.told_apart;  // intervals hold at least as often
  CHECK(coverage.inside >= expected - 3.3 * std::sqrt(0.05 * expected));
}

TEST_CASE("two modes that are one pole come back as one", "[analysis][modal]") {
  const Pole pole{low_hz, ratio};
  const ModesOfTaps found = found_in(channels_of(pole, pole), 20.0, 1);
  const std::vector<RepeatedMode> near = agreed_near(found, low_hz);
  REQUIRE(near.size() == 1);
  CHECK(contains(near.front().frequency_hz, low_hz));
  CHECK(contains(near.front().damping_ratio, ratio));
}

TEST_CASE("a mode whose frequency depends on the tap is not taken for two", "[analysis][modal]") {
  std::vector<Channel> channels;
  for (int impact = 0; impact < 6; ++impact) {
    const Pole pole{low_hz * (1.0 - 0.003 * impact), ratio};
    channels.push_back({impact, ringing_with({0.7, 0.0}, pole, pole)});
  }
  const ModesOfTaps found = found_in(channels, 30.0, 2);
  CHECK(agreed_near(found, low_hz).size() == 1);
}

TEST_CASE("what is told apart replaces what the taps alone showed", "[analysis][modal]") {
  const std::vector<Channel> channels = channels_of({low_hz, ratio}, {low_hz + 2.0, ratio});
  const ModesOfTaps found = found_in(channels, 30.0, 3);
  REQUIRE(agreed_near(found, low_hz).size() == 2);
  CHECK(found.modes.size() == 4);
  for (const TapModes& tap : found.taps) {
    CHECK(tap.modes.size() == 4);
    CHECK(tap.fit.modes.size() == 4);
    CHECK(tap.fit.explained > 0.99);
    CHECK(std::ranges::count(tap.modes, Standing::agreed, &TapMode::standing) == 4);
  }
}

TEST_CASE("a mode whose frequency falls with its amplitude is not taken for two",
          "[analysis][modal]") {
  core::Rng rng{4};
  std::vector<FreeDecay> decays;
  std::vector<int> impacts;
  std::vector<TapModes> alone;
  for (int impact = 0; impact < 6; ++impact) {
    FreeDecay decay{sampled_hz, Eigen::VectorXd(std::lround(sampled_hz * ring_s))};
    double phase_rad = 0.0;
    for (Eigen::Index n = 0; n < decay.samples.size(); ++n) {
      const double omega = 2.0 * std::numbers::pi * low_hz;
      const double amplitude =
          std::exp(-ratio * omega * static_cast<double>(n) / sampled_hz) * (0.8 + 0.05 * impact);
      decay.samples[n] = amplitude * std::sin(phase_rad) + 0.01 * rng.normal();
      phase_rad += omega * (1.0 - 0.005 * amplitude * amplitude) / sampled_hz;
    }
    decays.push_back(decay);
    impacts.push_back(impact);
    alone.push_back(identify_modes(decay, {sought}));
  }
  const ModesOfTaps by_taps{alone, modes_over_taps(alone, impacts)};
  REQUIRE(agreed_near(by_taps, low_hz).size() == 1);
  const ModesOfTaps found = resolve_close_modes(decays, impacts, sought, by_taps);
  CHECK(agreed_near(found, low_hz).size() == 1);
}

namespace {
constexpr double modulus_pa = 3e9;

// Two masses between springs to the ground and springs of the body itself, and others like it: each
// frequency squared is a stiffness of the body and one of the springs, side by side.
std::vector<double> frequencies_hz(double spring_factor) {
  std::vector<double> all;
  for (const double springs : {3.0, 0.6, 0.1, 0.4}) {
    const double first_hz = 40.0 + 60.0 * static_cast<double>(all.size());
    all.push_back(first_hz * std::sqrt(1.0 + springs * spring_factor));
  }
  return all;
}
// Measured of a body of other elasticity, on other springs, with errors.
std::vector<analysis::Estimate> measured(double modulus_factor, double spring_factor, double error,
                                         core::Rng& rng) {
  std::vector<analysis::Estimate> all;
  for (const double hz : frequencies_hz(spring_factor / modulus_factor)) {
    all.push_back({hz * std::sqrt(modulus_factor) * std::exp(error * rng.normal()), 0.0, {}, {}});
  }
  return all;
}
}  // namespace

TEST_CASE("springs and modulus planted in frequencies come back", "[analysis][identify]") {
  core::Rng rng{1};
  const auto [modulus, springs] =
      GENERATE(table<double, double>({{1.0, 0.3}, {0.8, 4.0}, {1.2, 1.0}}));
  const auto found =
      analysis::update_springs(measured(modulus, springs, 0.0, rng), frequencies_hz, modulus_pa);
  REQUIRE(found);
  CHECK(found->model.youngs_modulus_pa.value == Approx(modulus * modulus_pa).epsilon(1e-3));
  CHECK(found->spring_factor.value == Approx(springs).epsilon(3e-3));
  CHECK(found->model.matched.size() == 4);
}

TEST_CASE("the intervals of springs and modulus cover what was planted 95 times in 100",
          "[analysis][identify]") {
  core::Rng rng{2};
  constexpr int studies = 1000;
  int springs = 0;
  int modulus = 0;
  for (int i = 0; i < studies; ++i) {
    const auto found =
        analysis::update_springs(measured(1.1, 0.7, 0.003, rng), frequencies_hz, modulus_pa);
    REQUIRE(found);
    const auto covers = [](const analysis::Estimate& estimate, double planted) {
      return estimate.interval.low <= planted && planted <= estimate.interval.high;
    };
    springs += covers(found->spring_factor, 0.7) ? 1 : 0;
    modulus += covers(found->model.youngs_modulus_pa, 1.1 * modulus_pa) ? 1 : 0;
  }
  // 950 ± 6.9 would be exact; four standard errors
  CHECK(std::abs(springs - 950) <= 28);
  CHECK(std::abs(modulus - 950) <= 28);
}

TEST_CASE("springs of which the modes do not tell are not stated", "[analysis][identify]") {
  const auto rigid = [](double) { return std::vector<double>{40.0, 100.0, 180.0, 260.0}; };
  core::Rng rng{3};
  CHECK_FALSE(analysis::update_springs(measured(1.0, 1.0, 0.0, rng), rigid, modulus_pa));
  auto two = measured(1.0, 1.0, 0.0, rng);
  two.resize(2);
  CHECK_FALSE(analysis::update_springs(two, frequencies_hz, modulus_pa));
}
