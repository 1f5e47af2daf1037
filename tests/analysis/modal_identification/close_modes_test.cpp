// Modes that one tap shows as one are told apart by several taps or sensors that see them in
// different proportions.
#include "analysis/modal_identification/close_modes.hpp"

#include <algorithm>
#include <cmath>

#include "support/catch.hpp"
#include "support/synthetic_taps.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
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
  return tell_close_modes_apart(decays, impacts, sought, {alone, modes_over_taps(alone, impacts)});
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
          "[analysis][modal_identification][slow]") {
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

TEST_CASE("two modes that are one pole come back as one", "[analysis][modal_identification]") {
  const Pole pole{low_hz, ratio};
  const ModesOfTaps found = found_in(channels_of(pole, pole), 20.0, 1);
  const std::vector<RepeatedMode> near = agreed_near(found, low_hz);
  REQUIRE(near.size() == 1);
  CHECK(contains(near.front().frequency_hz, low_hz));
  CHECK(contains(near.front().damping_ratio, ratio));
}

TEST_CASE("a mode whose frequency depends on the tap is not taken for two",
          "[analysis][modal_identification]") {
  std::vector<Channel> channels;
  for (int impact = 0; impact < 6; ++impact) {
    const Pole pole{low_hz * (1.0 - 0.003 * impact), ratio};
    channels.push_back({impact, ringing_with({0.7, 0.0}, pole, pole)});
  }
  const ModesOfTaps found = found_in(channels, 30.0, 2);
  CHECK(agreed_near(found, low_hz).size() == 1);
}

TEST_CASE("what is told apart replaces what the taps alone showed",
          "[analysis][modal_identification]") {
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
          "[analysis][modal_identification]") {
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
  const ModesOfTaps found = tell_close_modes_apart(decays, impacts, sought, by_taps);
  CHECK(agreed_near(found, low_hz).size() == 1);
}
