#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/modal/decay/decay_band.hpp"
#include "analysis/modal/modes/assignment.hpp"
#include "analysis/modal/modes/close_modes.hpp"
#include "analysis/modal/modes/distinct_modes.hpp"
#include "analysis/modal/modes/mode_kinds.hpp"
#include "analysis/modal/modes/mode_shapes.hpp"
#include "analysis/modal/modes/model_matching.hpp"
#include "analysis/modal/modes/neighbourhood_fit.hpp"
#include "analysis/modal/modes/one_resonance.hpp"
#include "analysis/modal/modes/repeated_modes.hpp"
#include "analysis/modal/modes/steady_tone.hpp"
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
  const Eigen::Vector3cd shape{1.0, -2.0, 0.5};
  CHECK(modal_assurance(shape, std::complex{0.0, -3.0} * shape) == Approx(1.0).epsilon(1e-12));
  CHECK(modal_assurance(shape, Eigen::Vector3cd{2.0, 1.0, 0.0}) == Approx(0.0).margin(1e-12));
  CHECK(modal_assurance(shape, Eigen::Vector3cd::Zero()) == 0.0);
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

TEST_CASE("of one impact a mode may be shown by one sensor alone, of two impacts by both",
          "[analysis][modal]") {
  std::vector<TapModes> shown{tap_of(285.0, 0.03), tap_of(50.0, 0.01)};
  for (TapModes& tap : shown) {
    tap.fit.degrees_of_freedom = 100.0;
  }
  for (const RepeatedMode& mode : modes_over_taps(shown, {1, 1})) {
    CHECK(mode.standing == Standing::agreed);
  }
  for (const RepeatedMode& mode : modes_over_taps(shown, {1, 2})) {
    CHECK(mode.standing == Standing::doubtful);
  }
}

TEST_CASE("what most taps show far above their noise is a mode, even by one method",
          "[analysis][modal]") {
  std::vector<TapModes> taps;
  for (const double frequency_hz : {100.0, 100.2, 99.9, 100.1}) {
    taps.push_back(tap_of(frequency_hz, 0.01));
    TapMode& mode = taps.back().modes.front();
    mode.standing = Standing::doubtful;
    mode.by_rational_fit = mode.fitted.pole;
    mode.fitted.significance = 2000.0;
  }
  CHECK(modes_over_taps(taps).at(0).standing == Standing::agreed);
  for (TapModes& tap : taps) {
    tap.modes.front().fitted.significance = 2.0 * min_significance;
  }
  CHECK(modes_over_taps(taps).at(0).standing == Standing::doubtful);
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
    alone.push_back(identify_modes(decay, sought));
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
    alone.push_back(identify_modes(decay, sought));
  }
  const ModesOfTaps by_taps{alone, modes_over_taps(alone, impacts)};
  REQUIRE(agreed_near(by_taps, low_hz).size() == 1);
  const ModesOfTaps found = resolve_close_modes(decays, impacts, sought, by_taps);
  CHECK(agreed_near(found, low_hz).size() == 1);
}

namespace {
// A tap of a mode whose frequency falls by a share at an amplitude of 1, as joints make it, with
// what real recordings add: hum, the hand's slow movement, noise that falls over frequency, an
// echo.
struct Faults {
  double glide{0.004};
  double hum{0.02};
  double handling{0.04};
  double coloured{0.01};
  double reflection{0.12};
};
constexpr double gliding_hz = 331.0;
constexpr double gliding_ratio = 0.008;
constexpr double taps_rate_hz = 4000.0;

void add_gliding(double glide, double strength, double begin_s, FreeDecay& decay) {
  const double omega = 2.0 * std::numbers::pi * gliding_hz;
  double phase_rad = 0.0;
  for (Eigen::Index n = std::lround(begin_s * taps_rate_hz); n < decay.samples.size(); ++n) {
    const double t_s = static_cast<double>(n) / taps_rate_hz - begin_s;
    const double amplitude = strength * std::exp(-gliding_ratio * omega * t_s);
    decay.samples[n] += amplitude * std::sin(phase_rad);
    phase_rad += omega * (1.0 - glide * amplitude) / taps_rate_hz;
  }
}

FreeDecay faulty_tap(const Faults& faults, double strength, core::Rng& rng) {
  FreeDecay decay{taps_rate_hz, Eigen::VectorXd::Zero(1000)};
  add_gliding(faults.glide, strength, 0.0, decay);
  add_gliding(faults.glide, faults.reflection * strength, 0.011, decay);
  double brown = 0.0;
  const double turn = 2.0 * std::numbers::pi * rng.uniform();
  for (Eigen::Index n = 0; n < decay.samples.size(); ++n) {
    const double t_s = static_cast<double>(n) / taps_rate_hz;
    brown = 0.98 * brown + 0.2 * faults.coloured * rng.normal();
    decay.samples[n] += brown + faults.hum * std::sin(2.0 * std::numbers::pi * 50.0 * t_s + turn) +
                        faults.handling * std::sin(2.0 * std::numbers::pi * 9.0 * t_s + 2.0 * turn);
  }
  return decay;
}

struct FaultyTaps {
  std::vector<FreeDecay> decays;
  std::vector<int> impacts;
  ModesOfTaps found;
};
FaultyTaps identified(std::vector<FreeDecay> decays) {
  FaultyTaps taps{std::move(decays), {}, {}};
  for (const FreeDecay& decay : taps.decays) {
    taps.impacts.push_back(static_cast<int>(taps.impacts.size()));
    taps.found.taps.push_back(identify_modes(decay, sought));
  }
  const ModesOfTaps alone{taps.found.taps, modes_over_taps(taps.found.taps, taps.impacts)};
  taps.found = resolve_close_modes(taps.decays, taps.impacts, sought, alone);
  return taps;
}

// What is listed, as a recording's taps are treated.
std::vector<RepeatedMode> listed(FaultyTaps taps, const std::vector<FreeDecay>& rests) {
  const double later_s = settled_after_s(taps.decays, taps.impacts, sought, taps.found);
  if (later_s > 0.0) {
    std::vector<FreeDecay> later;
    for (const FreeDecay& decay : taps.decays) {
      later.push_back(begun_later(decay, later_s));
    }
    taps = identified(std::move(later));
  }
  std::vector<RepeatedMode> modes =
      distinct_modes(taps.decays, taps.impacts, sought, taps.found, rests);
  mark_background(rests, modes);
  judge_certainty(taps.decays.front().duration_s(), modes);
  std::erase_if(modes, [](const RepeatedMode& mode) { return mode.standing != Standing::agreed; });
  return modes;
}
}  // namespace

TEST_CASE("a mode that follows its amplitude is one mode, at rest, whatever else is recorded",
          "[analysis][modal]") {
  Faults faults;
  bool has_rest = true;
  SECTION("with faults of a usual recording") {}
  SECTION("in recordings that begin with the blow") {
    has_rest = false;
  }
  SECTION("with twice as large ones") {
    faults = {0.008, 0.04, 0.08, 0.02, 0.24};
  }
  core::Rng rng{6};
  std::vector<FreeDecay> decays;
  std::vector<FreeDecay> rests;
  for (int tap = 0; tap < 6; ++tap) {
    decays.push_back(faulty_tap(faults, 0.45 + 0.1 * tap, rng));
    const FreeDecay rest = faulty_tap(faults, 0.0, rng);
    rests.push_back(has_rest ? rest : FreeDecay{rest.rate_hz, {}});
  }
  std::vector<RepeatedMode> modes = listed(identified(std::move(decays)), rests);
  // what moves slowly at rest, too, is known by the rest alone
  std::erase_if(modes, [&](const RepeatedMode& mode) {
    return !has_rest && mode.frequency_hz.value < 0.5 * gliding_hz;
  });
  for (const RepeatedMode& mode : modes) {
    UNSCOPED_INFO(mode.frequency_hz.value << " Hz, " << mode.damping_ratio.value << " "
                                          << mode.why);
  }
  REQUIRE(modes.size() == 1);
  INFO(modes.front().frequency_hz.interval.low << " to "
                                               << modes.front().frequency_hz.interval.high);
  // a rate's error is not in these intervals
  CHECK(modes.front().frequency_hz.value == Approx(gliding_hz).epsilon(5e-4));
  CHECK(modes.front().damping_ratio.value == Approx(gliding_ratio).epsilon(0.05));
  REQUIRE(modes.front().at_tap);
  CHECK(modes.front().at_tap->frequency_hz < gliding_hz * (1.0 - 0.2 * faults.glide));
}

TEST_CASE("a level compressor makes no mode that a tap damps many times as fast as rest does",
          "[analysis][modal]") {
  constexpr double rate_hz = 16000.0;
  const Band band{100.0, 5000.0};
  FreeDecay decay = testing::planted_decay({{{630.0, 0.0029}, 0.3},
                                            {{645.0, 0.0017}, 0.5},
                                            {{1611.0, 0.0009}, 1.0},
                                            {{2760.0, 0.001}, 0.4},
                                            {{3494.0, 0.0014}, 0.4},
                                            {{4087.0, 0.0008}, 0.4}},
                                           rate_hz, 0.28);
  core::Rng rng{1};
  double level = 0.0;
  for (double& sample : decay.samples) {
    level = std::max(std::abs(sample), level * std::exp(-1.0 / (0.03 * rate_hz)));
    sample = sample / (1.0 + 10.0 * level) + 0.002 * rng.normal();
  }
  const TapModes tap = identify_modes(decay, band);
  const ModesOfTaps found{{tap}, modes_over_taps({tap}, {0})};
  for (const RepeatedMode& mode : distinct_modes({decay}, {0}, band, found)) {
    INFO(mode.frequency_hz.value << " Hz, " << mode.damping_ratio.value);
    CHECK((!mode.at_tap || mode.at_tap->damping_ratio <= 5.0 * mode.damping_ratio.value));
  }
}

TEST_CASE("a mode that hardly falls within a decay is no hum of the mains at high frequencies",
          "[analysis][modal]") {
  // every frequency is within a thousandth of a multiple of 50 or 60 Hz there
  const double frequency_hz = GENERATE(4010.0, 6020.0);
  constexpr double duration_s = 0.4;
  constexpr double falls_by = 0.4;  // nepers
  const double damping_ratio = falls_by / (2.0 * std::numbers::pi * frequency_hz * duration_s);
  FreeDecay decay =
      testing::planted_decay({{{frequency_hz, damping_ratio}, 1.0}}, 20000.0, duration_s);
  core::Rng rng{3};
  testing::add_noise(decay, 40.0, rng);
  const TapModes tap = identify_modes(decay, {0.8 * frequency_hz, 1.2 * frequency_hz});
  REQUIRE(tap.modes.size() == 1);
  CHECK(tap.modes.front().standing == Standing::agreed);
  CHECK(tap.modes.front().fitted.pole.damping_ratio == Approx(damping_ratio).epsilon(0.05));
}

TEST_CASE("two modes that all taps tell apart are not taken for one that follows its amplitude",
          "[analysis][modal]") {
  const double apart_hz = GENERATE(1.0, 2.0);
  const std::vector<Channel> channels = channels_of({low_hz, ratio}, {low_hz + apart_hz, ratio});
  std::vector<FreeDecay> decays;
  std::vector<int> impacts;
  std::vector<TapModes> alone;
  core::Rng rng{3};
  for (const Channel& channel : channels) {
    FreeDecay decay = testing::planted_decay(channel.modes, sampled_hz, ring_s);
    const double noise =
        testing::noise_for(testing::planted_decay(channel.modes, sampled_hz, 0.2), 30.0);
    for (double& sample : decay.samples) {
      sample += noise * rng.normal();
    }
    decays.push_back(decay);
    impacts.push_back(channel.impact);
    alone.push_back(identify_modes(decay, sought));
  }
  ModesOfTaps found =
      resolve_close_modes(decays, impacts, sought, {alone, modes_over_taps(alone, impacts)});
  REQUIRE(agreed_near(found, low_hz).size() == 2);
  CHECK(settled_after_s(decays, impacts, sought, found) == 0.0);
  found.modes = distinct_modes(decays, impacts, sought, found);
  CHECK(agreed_near(found, low_hz).size() == 2);
}

namespace {
RepeatedMode certain_mode(double frequency_hz, double damping_ratio, double amplitude) {
  RepeatedMode mode;
  mode.frequency_hz = t_estimate(frequency_hz, 1e-4 * frequency_hz, 10.0);
  mode.damping_ratio = t_estimate(damping_ratio, 0.02 * damping_ratio, 10.0);
  mode.amplitude = amplitude;
  mode.standing = Standing::agreed;
  return mode;
}
}  // namespace

TEST_CASE("what is not certain is no mode, and slow movement is background", "[analysis][modal]") {
  std::vector<RepeatedMode> modes{certain_mode(5.0, 0.02, 1.0), certain_mode(60.0, 0.02, 1.0),
                                  certain_mode(90.0, 0.02, 1.0), certain_mode(200.0, 0.02, 1.0)};
  modes[1].damping_ratio.interval.low = -1e-6;
  modes[2].frequency_hz.interval = {85.0, 95.0};
  judge_certainty(0.5, modes);  // 2.5 periods of 5 Hz
  CHECK(modes[0].standing == Standing::background);
  CHECK(modes[1].standing == Standing::doubtful);
  CHECK(modes[2].standing == Standing::doubtful);
  CHECK(modes[3].standing == Standing::agreed);
  const std::vector<std::string> others = summaries_of_others(modes);
  REQUIRE(others.size() == 2);  // one sentence a kind
  CHECK_THAT(others[0], Contains("2 components from 60 to 90 Hz: doubtful"));
  CHECK_THAT(others[1], Contains("1 component below 5 Hz: hum or handling"));
}

TEST_CASE("products of two motions are marked by their frequency and by their decay",
          "[analysis][modal]") {
  const double fast = 0.01;  // of 45.9 Hz: the product's rate is the sum of both
  const double slow = 0.02;
  const auto product = [&](double sign, double factor) {
    const double hz = 45.9 + sign * 6.9;
    return certain_mode(hz, factor * (45.9 * fast + 6.9 * slow) / hz, 0.1);
  };
  std::vector<RepeatedMode> modes{certain_mode(6.9, slow, 1.0),  product(-1.0, 1.0),
                                  certain_mode(45.9, fast, 1.0), product(1.0, 3.0),
                                  certain_mode(91.8, fast, 0.1), certain_mode(137.7, fast, 0.9)};
  mark_combinations(modes);
  CHECK(modes[1].standing == Standing::combination);
  CHECK_THAT(modes[1].why, Contains("45.9 Hz - 6.9 Hz"));
  CHECK(modes[3].standing == Standing::agreed);  // decays three times as fast as a product does
  CHECK(modes[4].standing == Standing::combination);
  CHECK(modes[5].standing == Standing::agreed);  // as strong as what would make it
}

namespace {
// A motion at 80 Hz, one at 1500 Hz and both sidebands, which decay so many times as fast as a
// product.
std::vector<RepeatedMode> modulated(double factor) {
  const auto sideband = [&](double hz) {
    return certain_mode(hz, factor * 0.002 * (1500.0 + 80.0) / hz, 0.1);
  };
  return {certain_mode(80.0, 0.002, 0.1), sideband(1420.0), certain_mode(1500.0, 0.002, 1.0),
          sideband(1580.0)};
}
}  // namespace

TEST_CASE("a slow motion that is weak only as an acceleration modulates a fast one",
          "[analysis][modal]") {
  const std::vector<RepeatedMode> modes = modulated(1.0);
  std::vector<RepeatedMode> as_displacement = modes;
  mark_combinations(as_displacement, 0);
  CHECK(as_displacement[1].standing == Standing::agreed);
  std::vector<RepeatedMode> as_acceleration = modes;  // 390 times as strong a displacement
  mark_combinations(as_acceleration, 2);
  CHECK(as_acceleration[1].standing == Standing::combination);
  CHECK(as_acceleration[2].standing == Standing::agreed);
  CHECK(as_acceleration[3].standing == Standing::combination);
}

TEST_CASE("a mode where a sideband would be is a mode if its mirror image is missing",
          "[analysis][modal]") {
  std::vector<RepeatedMode> modes = modulated(1.0);
  modes.pop_back();
  mark_combinations(modes, 2);
  CHECK(modes[1].standing == Standing::agreed);
}

TEST_CASE("what lies at a sideband and moves otherwise than the carrier is a mode",
          "[analysis][modal]") {
  std::vector<RepeatedMode> modes = modulated(1.0);
  mark_combinations(modes, 2, [](std::size_t one, std::size_t) { return one == 1 ? 0.2 : 0.9; });
  CHECK(modes[1].standing == Standing::agreed);
  CHECK(modes[3].standing == Standing::combination);
}

TEST_CASE("of a single decay weak neighbours of a mode and pulses are doubtful",
          "[analysis][modal]") {
  std::vector<RepeatedMode> modes{certain_mode(39.0, 0.02, 0.5), certain_mode(46.0, 0.02, 8.0),
                                  certain_mode(53.0, 0.01, 1.0), certain_mode(130.0, 0.02, 0.5),
                                  certain_mode(300.0, 0.2, 5.0)};
  judge_single_decay(1, 0.0, modes);
  CHECK(modes[0].standing == Standing::doubtful);
  CHECK_THAT(modes[0].why, Contains("46 Hz"));
  CHECK(modes[1].standing == Standing::agreed);
  CHECK(modes[2].standing == Standing::agreed);  // 18 dB
  CHECK(modes[3].standing == Standing::agreed);  // far from any stronger one
  CHECK(modes[4].standing == Standing::doubtful);
}

TEST_CASE("of one impact, what a slow motion moves and what follows a mode are doubtful",
          "[analysis][modal]") {
  std::vector<RepeatedMode> modes{certain_mode(130.0, 0.012, 1.0), certain_mode(137.0, 0.011, 0.2),
                                  certain_mode(124.0, 0.036, 0.8), certain_mode(285.0, 0.03, 0.5),
                                  certain_mode(900.0, 0.01, 0.01)};
  for (RepeatedMode& mode : modes) {
    mode.agreed = 1;
  }
  std::vector<RepeatedMode> of_two_sensors = modes;
  judge_single_decay(1, 6.9, modes);
  CHECK(modes[0].standing == Standing::agreed);
  CHECK_THAT(modes[1].why, Contains("motion at 6.9 Hz"));
  CHECK_THAT(modes[2].why, Contains("within the bandwidth"));
  CHECK(modes[3].standing == Standing::agreed);
  CHECK(modes[4].standing == Standing::agreed);
  of_two_sensors[0].agreed = 2;
  of_two_sensors[1].agreed = 2;
  of_two_sensors[2].amplitude = 2.0;  // stronger, but at one sensor alone
  judge_single_decay(2, 6.9, of_two_sensors);
  CHECK(of_two_sensors[1].standing == Standing::agreed);  // both show it
  CHECK_THAT(of_two_sensors[2].why, Contains("within the bandwidth"));
  CHECK_THAT(of_two_sensors[4].why, Contains("one of 2 sensors"));
}

TEST_CASE("what rings longer than the motions that would make it is no product of theirs",
          "[analysis][modal]") {
  std::vector<RepeatedMode> modes = modulated(0.75);
  mark_combinations(modes, 2);
  CHECK(modes[1].standing == Standing::agreed);
  CHECK(modes[3].standing == Standing::agreed);
}

TEST_CASE("what a cubic curve makes of three motions is no mode, one such sum alone is",
          "[analysis][modal]") {
  // the product of three decays by the sum of their rates
  const auto at = [](double hz, double rate_hz, double amplitude) {
    return certain_mode(hz, rate_hz / hz, amplitude);
  };
  std::vector<RepeatedMode> modes{at(97.0, 6.0, 0.05),  at(303.0, 1.5, 1.0),  at(500.0, 2.0, 0.8),
                                  at(706.0, 2.5, 0.6),  at(509.0, 2.0, 0.05), at(930.0, 6.0, 0.03),
                                  at(1509.0, 6.0, 0.05)};
  std::ranges::sort(modes, {}, [](const RepeatedMode& mode) { return mode.frequency_hz.value; });
  const auto named = [&](double hz) {
    return *std::ranges::find_if(
        modes, [hz](const RepeatedMode& mode) { return mode.frequency_hz.value == hz; });
  };
  mark_combinations(modes);
  CHECK(named(97.0).standing == Standing::combination);  // 303 + 500 - 706
  CHECK_THAT(named(97.0).why, Contains("303 Hz + 500 Hz - 706 Hz"));
  CHECK(named(930.0).standing == Standing::agreed);  // 27 Hz from 706 + 500 - 303
  CHECK(named(509.0).standing == Standing::agreed);  // 706 + 303 - 500, but outlasts it
  CHECK(named(1509.0).standing == Standing::combination);
  // one alone happens to lie there
  std::erase_if(modes, [](const RepeatedMode& mode) {
    return mode.frequency_hz.value > 1000.0 || mode.amplitude == 0.03 ||
           mode.frequency_hz.value == 509.0;
  });
  for (RepeatedMode& mode : modes) {
    mode.standing = Standing::agreed;
  }
  mark_combinations(modes);
  CHECK(named(97.0).standing == Standing::agreed);
}

TEST_CASE("what fewer than a third of the taps show is doubtful, weak modes of many are not",
          "[analysis][modal]") {
  std::vector<RepeatedMode> modes{certain_mode(300.0, 0.01, 1.0), certain_mode(700.0, 0.01, 0.5),
                                  certain_mode(900.0, 0.01, 0.01)};
  modes[0].taps = 12;
  modes[1].taps = 3;
  modes[2].taps = 4;
  judge_certainty(0.5, modes);
  CHECK(modes[1].standing == Standing::doubtful);
  CHECK_THAT(modes[1].why, Contains("3 of 12 taps"));
  CHECK(modes[2].standing == Standing::agreed);
}

namespace {
// Decays of a mode at 300 Hz and of a component next to it, with such amplitudes.
std::vector<RepeatedMode> joined_from(const std::vector<Shares>& shares, double ratio_beside) {
  std::vector<FreeDecay> decays;
  core::Rng rng{8};
  for (const Shares& seen : shares) {
    decays.push_back(testing::planted_decay(
        {{{300.0, 0.004}, seen.first}, {{301.0, ratio_beside}, seen.second}}, 3000.0, 0.5));
    for (double& sample : decays.back().samples) {
      sample += 0.005 * rng.normal();
    }
  }
  std::vector<RepeatedMode> modes{certain_mode(300.0, 0.004, 0.8),
                                  certain_mode(301.0, ratio_beside, 0.3)};
  join_resonances(decays, modes);
  return modes;
}
const std::vector<Shares> in_proportion{{0.5, 0.15}, {0.7, 0.21}, {1.0, 0.3}, {0.6, 0.18}};
}  // namespace

TEST_CASE("a part of a mode is none again by what overlaps it", "[analysis][modal]") {
  std::vector<FreeDecay> decays;
  for (const double strength : {0.5, 1.0, 0.7}) {
    decays.push_back(testing::planted_decay({{{300.0, 0.004}, strength},
                                             {{304.0, 0.03}, 0.6 * strength},
                                             {{312.0, 0.012}, 0.2 * strength}},
                                            3000.0, 0.5));
  }
  // the third overlaps the second, and the second the first
  std::vector<RepeatedMode> modes{certain_mode(300.0, 0.004, 0.7), certain_mode(304.0, 0.03, 0.4),
                                  certain_mode(312.0, 0.012, 0.14)};
  join_resonances(decays, modes);
  CHECK(modes[0].standing == Standing::agreed);
  for (const RepeatedMode& part : {modes[1], modes[2]}) {
    CHECK(part.standing == Standing::doubtful);
    CHECK_THAT(part.why, Contains("300 Hz"));
  }
}

TEST_CASE("what overlaps a mode, dies away sooner and follows its amplitude is a part of it",
          "[analysis][modal]") {
  const std::vector<RepeatedMode> modes = joined_from(in_proportion, 0.014);
  CHECK(modes[0].standing == Standing::agreed);
  CHECK(modes[1].standing == Standing::doubtful);
  CHECK_THAT(modes[1].why, Contains("300 Hz"));
}

TEST_CASE("what follows a mode in most taps is a part of it, whatever two taps struck twice show",
          "[analysis][modal]") {
  std::vector<Shares> shares = in_proportion;
  shares.insert(shares.end(), in_proportion.begin(), in_proportion.end());
  shares[2] = {1.5, -1.7};
  shares[5] = {1.2, -1.3};
  const std::vector<RepeatedMode> modes = joined_from(shares, 0.014);
  CHECK(modes[0].standing == Standing::agreed);  // the stronger one in the other taps
  CHECK(modes[1].standing == Standing::doubtful);
}

TEST_CASE("overlapping modes stay two where places or sensors see them in other proportions",
          "[analysis][modal]") {
  const std::vector<RepeatedMode> modes =
      joined_from({{0.8, 0.3}, {0.3, 0.8}, {0.7, -0.5}, {0.1, 0.6}}, 0.014);
  CHECK(modes[0].standing == Standing::agreed);
  CHECK(modes[1].standing == Standing::agreed);
}

TEST_CASE("two modes that die away alike are no series of one, in whatever proportion",
          "[analysis][modal]") {
  const std::vector<RepeatedMode> modes = joined_from(in_proportion, 0.005);
  CHECK(modes[0].standing == Standing::agreed);
  CHECK(modes[1].standing == Standing::agreed);
}

TEST_CASE("a mode that has died away when later decays begin is kept", "[analysis][modal]") {
  const std::vector<RepeatedMode> first{certain_mode(300.0, 0.004, 1.0),
                                        certain_mode(310.0, 0.03, 1.0),
                                        certain_mode(900.0, 0.02, 1.0)};
  const std::vector<RepeatedMode> later{certain_mode(301.0, 0.004, 1.0)};
  const std::vector<RepeatedMode> died = died_before(0.012, first, later);
  REQUIRE(died.size() == 1);  // 310 Hz overlaps what is seen later, 300 Hz is that
  CHECK(died.front().frequency_hz.value == 900.0);
  CHECK(died_before(0.001, first, later).empty());
}

TEST_CASE("what only the blow shows is a mode if reflections cannot be it, known less well",
          "[analysis][modal]") {
  const std::vector<RepeatedMode> first{certain_mode(300.0, 0.004, 1.0),
                                        certain_mode(900.0, 0.02, 0.5),
                                        certain_mode(1200.0, 0.02, 0.04)};
  RepeatedMode remainder = certain_mode(905.0, 0.02, 0.01);
  remainder.standing = Standing::doubtful;
  std::vector<RepeatedMode> later{first[0], remainder};
  const std::vector<RepeatedMode> died = died_before(0.012, first, later);
  REQUIRE(died.size() == 1);
  CHECK(died_before(0.012, {first[2]}, later).empty());  // the strongest is seen later on alone
  CHECK(died[0].frequency_hz.value == first[1].frequency_hz.value);
  // weak where decays begin, 2 ms after a blow in which it was not
  CHECK(died_before(0.012, {first[0], certain_mode(6000.0, 0.008, 0.05)}, later).size() == 1);
  CHECK(died_before(0.012, {first[0], certain_mode(340.0, 0.05, 0.07)}, later).empty());
  CHECK(died[0].frequency_hz.interval.high >= 900.0 + 900.0 * 0.02 / 3.0);
  CHECK(died[0].damping_ratio.interval.low <= 0.02 * 2.0 / 3.0);
  add_died(died, later);
  REQUIRE(later.size() == 2);
  CHECK(later[1].standing == Standing::agreed);
  add_died(died, later);  // it is there
  CHECK(later.size() == 2);
}

TEST_CASE("what is over in three periods and within a blow is as likely the blow's pulse",
          "[analysis][modal]") {
  std::vector<RepeatedMode> modes{certain_mode(150.0, 0.08, 1.0), certain_mode(1500.0, 0.04, 1.0),
                                  certain_mode(1600.0, 0.08, 1.0)};
  judge_certainty(0.5, modes);
  CHECK(modes[0].standing == Standing::agreed);  // outlasts a blow
  CHECK(modes[1].standing == Standing::agreed);  // four periods
  CHECK(modes[2].standing == Standing::doubtful);
}

TEST_CASE("what is as strong at rest as in the taps is no answer to them", "[analysis][modal]") {
  FreeDecay rest{1000.0, Eigen::VectorXd(400)};
  for (Eigen::Index n = 0; n < rest.samples.size(); ++n) {
    rest.samples[n] =
        0.02 * std::sin(2.0 * std::numbers::pi * 50.0 * static_cast<double>(n) / 1000.0 + 1.0);
  }
  CHECK(amplitude_at(50.0, rest) == Approx(0.02).epsilon(0.01));
  std::vector<RepeatedMode> modes{certain_mode(50.0, 0.01, 0.03), certain_mode(120.0, 0.01, 0.03)};
  // hum of 50 Hz is not near 120 Hz
  mark_background({rest, rest, rest}, modes);
  CHECK(modes[0].standing == Standing::background);
  CHECK(modes[1].standing == Standing::agreed);
}

TEST_CASE("the band ends above the highest mode that is not weak, however soon it dies away",
          "[analysis][modal]") {
  core::Rng rng{7};
  FreeDecay decay = testing::planted_decay(
      {{{400.0, 0.01}, 1.0}, {{2500.0, 0.02}, 0.3}, {{5000.0, 0.01}, 0.001}}, 16'000.0, 0.5);
  testing::add_noise(decay, 40.0, rng);
  const double highest_hz = highest_peak_hz({decay, decay, decay}, 10.0);
  CHECK(highest_hz > 2400.0);
  CHECK(highest_hz < 2800.0);
  const EnergyOutside outside = energy_outside({decay}, {10.0, 1000.0}, 10.0);
  CHECK(outside.peak_hz == Approx(2500.0).epsilon(0.02));
}

TEST_CASE("the band holds low modes side by side", "[analysis][modal]") {
  const FreeDecay decay = testing::planted_decay(
      {{{166.0, 0.01}, 1.0}, {{294.0, 0.01}, 0.6}, {{553.0, 0.01}, 0.4}}, 16'000.0, 0.5);
  const double highest_hz = highest_peak_hz({decay, decay, decay}, 10.0);
  CHECK(highest_hz > 550.0);
  CHECK(highest_hz < 720.0);
}

TEST_CASE("the band holds what rings on until the next tap cuts it off", "[analysis][modal]") {
  core::Rng rng{7};
  FreeDecay decay = testing::planted_decay({{{200.0, 0.0015}, 1.0}, {{415.0, 0.0015}, 0.6}}, 8000.0,
                                           0.237);  // fallen by less than half
  testing::add_noise(decay, 40.0, rng);
  const double end_hz = band_end_hz({decay, decay, decay}, 10.0);
  CHECK(end_hz > 430.0);
  CHECK(end_hz < 700.0);
}

TEST_CASE("the band holds most of the energy, whatever its peaks do", "[analysis][modal]") {
  const FreeDecay tone = testing::planted_decay({{{700.0, 0.0}, 1.0}}, 8000.0, 0.3);
  const double end_hz = band_end_hz({tone, tone, tone}, 10.0);
  CHECK(energy_outside({tone}, {10.0, end_hz}, 10.0).share < 0.5);
}

namespace {
constexpr double humming_hz = 100.04;
// From when a mode of the same frequency was struck, hum beside it.
FreeDecay hum_from(double begin_s, double duration_s, double hum, double mode, core::Rng& rng) {
  FreeDecay decay{4000.0, Eigen::VectorXd(std::lround(4000.0 * duration_s))};
  for (Eigen::Index n = 0; n < decay.samples.size(); ++n) {
    const double t_s = begin_s + static_cast<double>(n) / decay.rate_hz;
    const double omega = 2.0 * std::numbers::pi * humming_hz;
    decay.samples[n] = hum * std::sin(omega * t_s + 2.0) + 0.002 * rng.normal() +
                       mode * std::exp(-0.01 * omega * t_s) * std::sin(omega * t_s);
  }
  return decay;
}
}  // namespace

TEST_CASE("a steady tone is known beside what is left of a mode of its frequency",
          "[analysis][modal]") {
  core::Rng rng{7};
  const FreeDecay stretch = hum_from(0.3, 0.5, 0.15, 1.0, rng);
  const auto tone = steady_tone(stretch, 99.5, 2.0);
  REQUIRE(tone);
  CHECK(std::abs(tone->frequency_hz - humming_hz) < 4.0 * tone->frequency_error_hz);
  FreeDecay later = hum_from(0.9, 0.3, 0.15, 0.0, rng);
  take_tone(*tone, 0.6, later);
  const double left = later.samples.norm() / std::sqrt(static_cast<double>(later.samples.size()));
  CHECK(left < std::hypot(0.002, 2.0 * tone->error_at(0.75)));
  CHECK(tone->error_at(0.75) < 0.05 * 0.15);
}

TEST_CASE("what decays, and noise, is no steady tone", "[analysis][modal]") {
  core::Rng rng{7};
  CHECK_FALSE(steady_tone(hum_from(0.1, 0.5, 0.0, 1.0, rng), humming_hz, 2.0));
  CHECK_FALSE(steady_tone(hum_from(0.1, 0.5, 0.0, 0.0, rng), humming_hz, 2.0));
  // a mode that would ring through the stretch looks like a tone
  const FreeDecay hum = hum_from(0.1, 0.5, 0.15, 0.0, rng);
  CHECK(tone_near(certain_mode(humming_hz, 0.01, 1.0), {{hum, 0.6}}, 2.0));
  CHECK_FALSE(tone_near(certain_mode(humming_hz, 0.001, 1.0), {{hum, 0.6}}, 2.0));
}

TEST_CASE("what may still ring of the last blow is no steady tone", "[analysis][modal]") {
  core::Rng rng{7};
  FreeDecay stretch = testing::planted_decay({{{793.9, 1.2e-4}, 1.0}}, 4000.0, 0.5);
  testing::add_noise(stretch, 40.0, rng);
  CHECK(steady_tone(stretch, 793.9, 2.0));  // falls by a quarter within it
  CHECK_FALSE(steady_tone(stretch, 793.9, 2.0, 2.0));
  const FreeDecay hum = hum_from(0.3, 0.5, 0.15, 0.0, rng);
  CHECK(steady_tone(hum, humming_hz, 2.0, 2.0));
}

TEST_CASE("a mode beside a tone that few taps know is known less well", "[analysis][modal]") {
  core::Rng rng{7};
  const FreeDecay hum = hum_from(0.1, 0.5, 0.05, 0.0, rng);
  const QuietStretch none{{4000.0, Eigen::VectorXd::Zero(10)}, 0.1};
  const RepeatedMode mode = certain_mode(humming_hz, 0.01, 1.0);
  const auto tones_by = [&](const std::vector<QuietStretch>& stretches) {
    std::vector<RepeatedMode> modes{mode};
    tell_of_tones(tones_in(modes, stretches, 0.3), 0.3, modes);
    return modes.front();
  };
  const RepeatedMode known = tones_by({{hum, 0.6}, {hum, 0.6}});
  CHECK_THAT(known.why, Contains("a steady tone of 100.04 Hz, 26 dB below it"));
  CHECK(known.damping_ratio.interval.low == Approx(mode.damping_ratio.interval.low).epsilon(0.01));
  const RepeatedMode half = tones_by({{hum, 0.6}, none});
  CHECK_THAT(half.why, Contains("fitted beside it in 1 of 2 taps") && Contains("less certain"));
}

TEST_CASE("the mains' other harmonics tell of one in a mode that no stretch shows",
          "[analysis][modal]") {
  std::vector<RepeatedMode> modes{certain_mode(50.02, 1e-5, 0.1), certain_mode(100.3, 0.01, 1.0),
                                  certain_mode(150.06, 1e-5, 0.1), certain_mode(430.0, 0.002, 1.0)};
  modes[0].standing = Standing::line;
  modes[2].standing = Standing::line;
  const QuietStretch none{{4000.0, Eigen::VectorXd::Zero(10)}, 0.1};
  const std::vector<ToneOfTaps> tones = tones_in(modes, {none, none}, 0.3);
  REQUIRE(tones.size() == 1);
  CHECK(tones[0].frequency_hz == Approx(100.04));
  core::Rng rng{7};
  const QuietStretch silent{hum_from(0.1, 0.5, 0.0, 0.0, rng), 0.6};
  CHECK(tones_in(modes, {silent, none}, 0.3).empty());
  modes[0].standing = Standing::agreed;  // one line may be any tone
  CHECK(tones_in(modes, {none, none}, 0.3).empty());
}

TEST_CASE("poles without some decays are to first order what a fit of the others gives",
          "[analysis][modal]") {
  core::Rng rng{12};
  const Band around{20.0, 400.0};
  const std::vector<Pole> planted{{100.0, 0.02}, {180.0, 0.015}};
  std::vector<BandSpectrum> spectra;
  for (int i = 0; i < 6; ++i) {
    FreeDecay decay = testing::planted_decay(
        {{planted[0], 0.5 + rng.uniform()}, {planted[1], 0.5 + rng.uniform()}}, 2000.0, 0.5);
    testing::add_noise(decay, 30.0, rng);
    spectra.push_back(band_spectrum(decay, around));
  }
  std::vector<SharingDecay> decays;
  for (const BandSpectrum& spectrum : spectra) {
    decays.push_back({&spectrum, {}, {}, 1.0});
  }
  const auto poles_of = [](const SharedFit& fit) {
    return std::vector<Pole>{fit.decays[0].modes[0].pole, fit.decays[0].modes[1].pole};
  };
  const std::vector<Pole> of_all = poles_of(fit_shared_poles(decays, planted));
  const auto without = shared_poles_without(decays, of_all, {0, 1, 2, 0, 1, 2}, 3);
  REQUIRE(without.size() == 3);
  const std::vector<Pole> fitted =
      poles_of(fit_shared_poles({decays[1], decays[2], decays[4], decays[5]}, of_all));
  for (std::size_t k = 0; k < 2; ++k) {
    const double moved_hz = fitted[k].frequency_hz - of_all[k].frequency_hz;
    CHECK(without[0][k].frequency_hz - of_all[k].frequency_hz ==
          Approx(moved_hz).epsilon(0.1).margin(1e-5));
  }
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
          "[analysis][identify][slow]") {
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

TEST_CASE("a decay is kept for as long as it rings, for a part of the band of any width",
          "[analysis][modal]") {
  constexpr double rate_hz = 4000.0;
  constexpr double decay_per_s = 8.0;
  constexpr double noise = 1e-4;
  for (const double frequency_hz : {20.0, 45.9, 300.0, 900.0}) {
    core::Rng rng{7};
    analysis::FreeDecay decay{rate_hz, Eigen::VectorXd{12'000}};
    for (Eigen::Index i = 0; i < decay.samples.size(); ++i) {
      const double t_s = static_cast<double>(i) / rate_hz;
      decay.samples[i] =
          std::exp(-decay_per_s * t_s) * std::sin(2.0 * std::numbers::pi * frequency_hz * t_s) +
          noise * rng.normal();
    }
    for (const double share : {0.0, 0.05, 0.5}) {
      INFO(frequency_hz << " Hz, " << share);
      const double kept_s = analysis::shortened_for(
                                {(1.0 - share) * frequency_hz, (1.0 + share) * frequency_hz}, decay)
                                .duration_s();
      CHECK(std::exp(-decay_per_s * kept_s) < 10.0 * noise);
      CHECK(kept_s <= 3.0);
    }
  }
}

TEST_CASE("a strong motion below the band does not falsify the damping of a single decay's modes",
          "[analysis][modal]") {
  constexpr double rate_hz = 1650.0;
  const std::vector<Pole> poles{{41.4, 0.0015}, {116.9, 0.0026}};
  int seen = 0;
  int held = 0;
  double error_of_band = 0.0;
  double error = 0.0;
  for (const double strength : {0.5, 1.0, 1.5}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      core::Rng rng{seed};
      FreeDecay decay = testing::planted_decay({{{6.62, 0.003}, strength, 0.3},
                                                {poles[0], 1.0, 0.3},
                                                {poles[1], 1.0, 1.0},
                                                {{568.5, 0.0006}, 5.0, 0.0}},
                                               rate_hz, 2.0);
      testing::add_noise(decay, 80.0, rng);
      const Band band{10.0, 700.0};
      const std::vector<TapModes> taps{identify_modes(decay, band)};
      const std::vector<RepeatedMode> before = modes_over_taps(taps);
      std::vector<RepeatedMode> after = before;
      fit_neighbourhoods({decay}, band, taps, after);
      for (std::size_t i = 0; i < after.size(); ++i) {
        const auto known = std::ranges::find_if(poles, [&](const Pole& pole) {
          return std::abs(after[i].frequency_hz.value / pole.frequency_hz - 1.0) < 0.01;
        });
        if (known != poles.end() && after[i].standing == Standing::agreed) {
          const double ratio = known->damping_ratio;
          ++seen;
          held += after[i].damping_ratio.interval.low <= ratio &&
                          ratio <= after[i].damping_ratio.interval.high
                      ? 1
                      : 0;
          error_of_band += std::abs(before[i].damping_ratio.value / ratio - 1.0);
          error += std::abs(after[i].damping_ratio.value / ratio - 1.0);
        }
      }
    }
  }
  CHECK(seen == 18);
  CHECK(held >= seen - 2);
  CHECK(error < 0.2 * error_of_band);
  CHECK(error / seen < 0.005);
}

namespace {
// Modes that white noise moves, to this standard deviation each.
FreeDecay at_rest(const std::vector<Pole>& poles, double deviation, double rate_hz,
                  double duration_s, core::Rng& rng) {
  constexpr Eigen::Index until_steady = 20'000;
  FreeDecay rest{rate_hz, Eigen::VectorXd::Zero(std::lround(rate_hz * duration_s))};
  for (const Pole& pole : poles) {
    const std::complex<double> z = std::exp(log_of(pole, rate_hz));
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(until_steady + rest.samples.size());
    for (Eigen::Index n = 2; n < moved.size(); ++n) {
      moved[n] = 2.0 * z.real() * moved[n - 1] - std::norm(z) * moved[n - 2] + rng.normal();
    }
    const double size = moved.norm() / std::sqrt(static_cast<double>(moved.size()));
    rest.samples += deviation / size * moved.tail(rest.samples.size());
  }
  return rest;
}
}  // namespace

TEST_CASE(
    "linear modes follow no amplitude in short decays beside others, nor where they move at "
    "rest",
    "[analysis][modal]") {
  constexpr double rate_hz = 8000.0;
  std::vector<Pole> poles{{120.0, 0.015}, {300.0, 0.012}};
  double duration_s = 0.1;
  double deviation_at_rest = 0.0;
  SECTION("in short decays") {}
  SECTION("where they move at rest") {
    poles = {{200.0, 0.02}, {330.0, 0.015}};
    duration_s = 0.28;
    deviation_at_rest = 0.005;
  }
  core::Rng rng{11};
  std::vector<FreeDecay> decays;
  std::vector<FreeDecay> rests;
  for (int tap = 0; tap < 4; ++tap) {
    FreeDecay decay =
        testing::planted_decay({{poles[0], 1.0}, {poles[1], 0.6}}, rate_hz, duration_s);
    testing::add_noise(decay, 54.0, rng);
    const FreeDecay moved = at_rest(poles, deviation_at_rest, rate_hz, duration_s + 0.2, rng);
    decay.samples += moved.samples.tail(decay.samples.size());
    decays.push_back(std::move(decay));
    rests.push_back({rate_hz, moved.samples.head(std::lround(0.2 * rate_hz))});
  }
  const std::vector<RepeatedMode> modes = listed(identified(std::move(decays)), rests);
  for (const Pole& pole : poles) {
    const auto found = std::ranges::find_if(modes, [&](const RepeatedMode& mode) {
      return std::abs(mode.frequency_hz.value / pole.frequency_hz - 1.0) < 0.005;
    });
    INFO(pole.frequency_hz << " Hz");
    REQUIRE(found != modes.end());
    CHECK_FALSE(found->at_tap);
    CHECK(found->damping_ratio.value == Approx(pole.damping_ratio).epsilon(0.05));
  }
}
