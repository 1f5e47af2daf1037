#include "runner/laboratory/identify/tap_identification.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "runner/laboratory/identify/fits_over_taps.hpp"
#include "runner/laboratory/identify/modal_report.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/synthetic_taps.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
// A sensor that works, another that shows 0.37 all the time.
std::string two_sensors() {
  const analysis::Recording recording = testing::planted_recording(
      {{{62.0, 0.03}}, {{118.0, 0.02}}}, {0.4, 1.7, 3.0}, 3000.0, 4.3, 0.01, 5);
  std::string text = "live,dead\n";
  for (const double sample : recording.samples) {
    text += fmt::format("{:.7g},0.37\n", sample);
  }
  return text;
}

runner::TapIdentification identified(const std::string& file, std::vector<std::string> columns) {
  runner::TapQuestion question;
  question.recordings = {file};
  question.reading.rate_hz = 3000.0;
  question.band = analysis::Band{20.0, 400.0};
  question.columns = std::move(columns);
  runner::Progress progress{"identifying"};
  return runner::identify_taps(question, progress);
}
}  // namespace

TEST_CASE("a sensor that shows nothing is left out with a remark, and the others count",
          "[runner][identify]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.csv";
  testing::write(file, two_sensors());
  const runner::TapIdentification found = identified(file, {"dead", "live"});
  CHECK(found.agreed.size() == 2);
  CHECK(found.taps.size() == 3);
  REQUIRE(found.remarks.size() == 1);  // one a kind
  CHECK_THAT(found.remarks.front(), Contains("3 of 3 taps: dead does not change"));
}

TEST_CASE("sensors that show noise or hum alone are left out, and tell no taps",
          "[runner][identify]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.csv";
  const analysis::Recording live = testing::planted_recording(
      {{{62.0, 0.03}}, {{118.0, 0.02}}}, {0.4, 1.7, 3.0}, 3000.0, 4.3, 0.01, 5);
  core::Rng rng{6};
  std::string text = "noise,hum,live\n";
  for (std::size_t i = 0; i < live.samples.size(); ++i) {
    const double hum =
        0.05 * std::sin(2.0 * std::numbers::pi * 50.0 * static_cast<double>(i) / 3000.0);
    text += fmt::format("{:.7g},{:.7g},{:.7g}\n", 0.01 * rng.normal(), hum + 0.001 * rng.normal(),
                        live.samples[i]);
  }
  testing::write(file, text);
  const runner::TapIdentification found = identified(file, {"noise", "hum", "live"});
  CHECK(found.agreed.size() == 2);
  CHECK(found.taps.size() == 3);
  REQUIRE(found.remarks.size() == 2);
  CHECK_THAT(found.remarks.front(),
             Contains("3 of 3 taps: noise shows nothing above its noise, and is left out"));
}

// The oracle is what was planted. Clipped, the beginning looks as if it decayed less.
TEST_CASE("the decaying sinusoid is fitted to taps that are not clipped, and to no others",
          "[runner][identify]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.csv";
  const analysis::Pole planted{62.0, 0.03};
  const analysis::Recording strong =
      testing::planted_recording({{planted}}, {0.4}, 3000.0, 4.3, 0.0, 5);
  const analysis::Recording weak =
      testing::planted_recording({{planted}}, {1.7, 3.0}, 3000.0, 4.3, 0.001, 5);
  const double most_of_weak = *std::ranges::max_element(weak.samples);
  const auto clipped_at = [&](double limit) {
    std::string text = "live\n";
    for (std::size_t i = 0; i < weak.samples.size(); ++i) {
      const double sample = 3.0 * strong.samples[i] + weak.samples[i];
      text += fmt::format("{:.7g}\n", std::clamp(sample, -limit, limit));
    }
    testing::write(file, text);
    return identified(file, {"live"});
  };
  const double decay_per_s = planted.damping_ratio * 2.0 * std::numbers::pi * planted.frequency_hz;
  const runner::TapIdentification some = clipped_at(1.1 * most_of_weak);
  REQUIRE(some.sinusoid);
  CHECK(some.sinusoid->decay_per_s.value == Approx(decay_per_s).epsilon(0.01));
  const runner::TapIdentification all = clipped_at(0.5 * most_of_weak);
  CHECK_FALSE(all.sinusoid);
  CHECK(all.agreed.size() == 1);
}

// The oracle is what was planted: over both blows a decay is another one.
TEST_CASE("no decaying sinusoid is fitted to taps that were struck twice", "[runner][identify]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.csv";
  const double rate_hz = 8192.0;
  const analysis::Pole planted{200.0, 0.01};
  const auto identified_of = [&](const std::vector<double>& blows_s) {
    const analysis::Recording live =
        testing::planted_recording({{planted}}, blows_s, rate_hz, 3.0, 0.001, 5);
    std::vector<double> force(live.samples.size(), 0.0);
    for (const double blow_s : blows_s) {
      const auto first = static_cast<std::size_t>(std::lround(blow_s * rate_hz));
      std::fill_n(force.begin() + static_cast<std::ptrdiff_t>(first), 8, 10.0);
    }
    std::string text = "live,force\n";
    for (std::size_t i = 0; i < force.size(); ++i) {
      text += fmt::format("{:.7g},{:.7g}\n", live.samples[i], force[i]);
    }
    testing::write(file, text);
    runner::TapQuestion question;
    question.recordings = {file};
    question.columns = {"live"};
    question.reading.rate_hz = rate_hz;
    question.force_column = "force";
    runner::Progress progress{"identifying"};
    return runner::identify_taps(question, progress);
  };
  CHECK_FALSE(identified_of({0.4, 0.414, 1.7, 1.714}).sinusoid);
  const runner::TapIdentification once = identified_of({0.4, 0.414, 1.7});
  REQUIRE(once.sinusoid);
  CHECK(
      once.sinusoid->decay_per_s.value ==
      Approx(planted.damping_ratio * 2.0 * std::numbers::pi * planted.frequency_hz).epsilon(0.01));
}

// A wide band is looked at part by part. The oracle is what was planted, almost without noise.
TEST_CASE("a mode's damping does not depend on modes in other parts of the band",
          "[runner][identify]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.csv";
  const std::vector<testing::PlantedMode> planted{
      {{200.0, 0.010}, 1.0}, {{415.0, 0.008}, 0.6}, {{1100.0, 0.005}, 0.4}};
  const analysis::Recording recording =
      testing::planted_recording(planted, {0.3, 1.4}, 12000.0, 2.5, 1e-5, 5);
  std::string text = "live\n";
  for (const double sample : recording.samples) {
    text += fmt::format("{:.9g}\n", sample);
  }
  testing::write(file, text);
  runner::TapQuestion question;
  question.recordings = {file};
  question.reading.rate_hz = recording.rate_hz;
  question.band = analysis::Band{10.0, 2500.0};
  runner::Progress progress{"identifying"};
  const runner::TapIdentification found = runner::identify_taps(question, progress);
  REQUIRE(found.agreed.size() == planted.size());
  for (std::size_t i = 0; i < planted.size(); ++i) {
    const analysis::RepeatedMode& mode = found.modes[found.agreed[i]];
    CHECK(mode.frequency_hz.value == Approx(planted[i].pole.frequency_hz).epsilon(1e-6));
    CHECK(mode.damping_ratio.value == Approx(planted[i].pole.damping_ratio).epsilon(2e-4));
  }
}

namespace {
bool contains(const analysis::Estimate& estimate, double value) {
  return estimate.interval.low <= value && value <= estimate.interval.high;
}

constexpr double humming_rate_hz = 4000.0;

runner::TapIdentification found_in(const std::string& file, const std::vector<double>& samples,
                                   double rate_hz = humming_rate_hz) {
  std::string text = "live\n";
  for (const double sample : samples) {
    text += fmt::format("{:.7g}\n", sample);
  }
  testing::write(file, text);
  runner::TapQuestion question;
  question.recordings = {file};
  question.reading.rate_hz = rate_hz;
  runner::Progress progress{"identifying"};
  return runner::identify_taps(question, progress);
}

// Hum of the mains and its harmonics, of this amplitude at the second; its frequency wanders.
void add_hum(double amplitude, double wanders_hz, std::vector<double>& samples) {
  double phase_rad = 0.0;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const double t_s = static_cast<double>(n) / humming_rate_hz;
    for (int k = 1; k <= 8; ++k) {
      samples[n] += 2.0 * amplitude / k * std::sin(k * phase_rad + k);
    }
    const double hz = 50.02 + wanders_hz * std::sin(2.0 * std::numbers::pi * t_s / 7.0);
    phase_rad += 2.0 * std::numbers::pi * hz / humming_rate_hz;
  }
}
}  // namespace

// The oracle is what was planted. No decay is long enough to tell such a tone from the mode.
TEST_CASE("hum within a mode's width is taken out of it, and that is said", "[runner][identify]") {
  const testing::TempDirectory directory;
  const auto [mode_hz, hum, wanders_hz] = GENERATE(values<std::tuple<double, double, double>>(
      {{100.04, 0.15, 0.0}, {100.04, 0.05, 0.0}, {200.0, 0.1, 0.03}, {100.3, 0.1, 0.0}}));
  std::vector<double> samples =
      testing::planted_recording({{{mode_hz, 0.01}}, {{415.0, 0.008}, 0.6}},
                                 {0.5, 1.8, 3.1, 4.4, 5.7, 7.0}, humming_rate_hz, 8.5, 0.002, 3)
          .samples;
  add_hum(hum, wanders_hz, samples);
  const runner::TapIdentification found = found_in(directory / "taps.csv", samples);
  INFO(mode_hz << " Hz, hum " << hum);
  REQUIRE(found.agreed.size() == 2);
  const analysis::RepeatedMode& mode = found.modes[found.agreed[0]];
  INFO(mode.damping_ratio.interval.low << " to " << mode.damping_ratio.interval.high);
  CHECK(contains(mode.damping_ratio, 0.01));
  CHECK(mode.damping_ratio.value == Approx(0.01).epsilon(0.03));
  CHECK_FALSE(mode.at_tap);
  CHECK_THAT(mode.why, Contains("a steady tone of"));
  CHECK_THAT(runner::yaml_of(found), Contains(mode.why));
  CHECK(found.modes[found.agreed[1]].why.empty());
}

TEST_CASE("a weak movement that shares no mode with the hardest tap is none, a weak tap is one",
          "[runner][identify]") {
  const testing::TempDirectory directory;
  const auto [bump, hz, taps] = GENERATE(values<std::tuple<std::string, double, std::size_t>>(
      {{"a rumble", 24.0, 1}, {"a weaker tap", 118.0, 2}}));
  analysis::Recording recording =
      testing::planted_recording({{{62.0, 0.03}}, {{118.0, 0.02}}}, {0.4}, 3000.0, 3.0, 1e-4, 5);
  for (std::size_t n = 4500; n < recording.samples.size(); ++n) {
    recording.samples[n] +=
        0.06 * testing::ringing({{{hz, 0.02}}}, (static_cast<double>(n) - 4500.0) / 3000.0);
  }
  const std::string file = directory / "taps.csv";
  std::string text = "a\n";
  for (const double sample : recording.samples) {
    text += fmt::format("{:.7g}\n", sample);
  }
  testing::write(file, text);
  const runner::TapIdentification found = identified(file, {"a"});
  INFO(bump);
  CHECK(found.taps.size() == taps);
  CHECK(std::ranges::any_of(found.remarks, [](const std::string& remark) {
          return remark.find("shares no mode with the hardest tap") != std::string::npos;
        }) == (taps == 1));
  if (taps == 1) {
    CHECK(found.agreed.size() == 2);
  }
}

// What was planted is linear; the converter's steps hide much of it.
TEST_CASE("a mode that would grow at a tap, or hardly fall at rest, follows no amplitude",
          "[runner][identify]") {
  const testing::TempDirectory directory;
  const double rate_hz = GENERATE(4000.0, 8000.0);
  std::vector<double> samples =
      testing::planted_recording({{{200.0, 0.01}}, {{415.0, 0.008}, 0.6}, {{1100.0, 0.005}, 0.4}},
                                 {0.5, 1.8, 3.1, 4.4, 5.7, 7.0}, rate_hz, 8.5, 0.0, 4)
          .samples;
  std::uint64_t state = 1;
  for (double& sample : samples) {
    state = (1103515245 * state + 12345) % 2147483648;
    sample =
        std::round(12.7 * (sample + 0.004 * static_cast<double>(state) / 2147483648.0 - 0.002));
  }
  const runner::TapIdentification found = found_in(directory / "taps.csv", samples, rate_hz);
  CHECK_FALSE(found.agreed.empty());
  for (const std::size_t i : found.agreed) {
    INFO(found.modes[i].frequency_hz.value << " Hz");
    CHECK_FALSE(found.modes[i].at_tap);
  }
}

TEST_CASE("one channel named in two ways is refused", "[runner][identify]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.csv";
  testing::write(file, two_sensors());
  CHECK_THROWS_WITH(identified(file, {"live", "1"}), Contains("'live' is named twice"));
}

namespace {
constexpr double stated_hz = 3000.0;
constexpr double wrong_by = 0.0009;
const std::vector<testing::PlantedMode> planted{{{62.0, 0.03}}, {{118.0, 0.02}}, {{260.0, 0.03}}};

// Sampled somewhat faster than the times say.
std::string recording_of(const std::vector<double>& times_s) {
  const analysis::Recording recording = testing::planted_recording(
      planted, times_s, stated_hz * (1.0 + wrong_by), times_s.back() + 1.3, 0.01, 3);
  std::string text = "time_s,acceleration\n";
  for (std::size_t n = 0; n < recording.samples.size(); ++n) {
    text +=
        fmt::format("{:.7f},{:.7g}\n", static_cast<double>(n) / stated_hz, recording.samples[n]);
  }
  return text;
}

runner::TapIdentification identified(const std::string& file, double rate_error) {
  runner::TapQuestion question;
  question.recordings = {file};
  question.band = analysis::Band{20.0, 400.0};
  question.rate_error = rate_error;
  runner::Progress progress{"identifying"};
  return runner::identify_taps(question, progress);
}
}  // namespace

TEST_CASE("intervals hold what was planted although the rate is somewhat wrong",
          "[runner][identify]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.csv";
  testing::write(file, recording_of({0.4, 1.7, 3.0, 4.3}));
  const runner::TapIdentification found = identified(file, 0.001);
  const runner::TapIdentification trusting = identified(file, 0.0);
  REQUIRE(found.modes.size() == planted.size());
  for (std::size_t i = 0; i < planted.size(); ++i) {
    INFO(planted[i].pole.frequency_hz << " Hz");
    CHECK(contains(found.modes[i].frequency_hz, planted[i].pole.frequency_hz));
    CHECK(contains(found.modes[i].damping_ratio, planted[i].pole.damping_ratio));
    CHECK_FALSE(contains(trusting.modes[i].frequency_hz, planted[i].pole.frequency_hz));
  }
}

TEST_CASE("an error of the rate is one of alpha, against beta, and twice one of Young's modulus",
          "[runner][identify]") {
  runner::TapIdentification found;
  const analysis::Estimate sharp{100.0, 0.0, {100.0, 100.0}, {}};
  found.rayleigh.emplace();
  found.rayleigh->alpha_per_s = sharp;
  found.rayleigh->beta_s = sharp;
  found.model.emplace().update.emplace();
  found.model->update->youngs_modulus_pa = sharp;
  runner::include_rate_error(0.01, found);
  // all from f and zeta alone: alpha ~ f, beta ~ 1 / f, E ~ f^2, f between 1 / 1.01 and 1.01
  CHECK(found.rayleigh->alpha_per_s.interval.high == Approx(101.0));
  CHECK(found.rayleigh->beta_s.interval.low == Approx(100.0 / 1.01));
  CHECK(found.model->update->youngs_modulus_pa.interval.high == Approx(102.01));
  CHECK(found.model->update->youngs_modulus_pa.interval.low == Approx(100.0 / 1.0201));
}

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

TEST_CASE("taps and sensors dominated by different modes have no mean decaying sinusoid",
          "[runner][identify]") {
  const auto found_of = [](const std::vector<double>& frequencies_hz, double error_hz) {
    runner::TapIdentification found;
    for (const double frequency_hz : frequencies_hz) {
      runner::IdentifiedTap tap;
      tap.impact = static_cast<int>(found.taps.size() / 2) + 1;
      tap.channel = found.taps.size() % 2 == 0 ? "tip" : "nail";
      tap.sinusoid = analysis::FittedSinusoid{};
      tap.sinusoid->frequency_hz = frequency_hz;
      tap.sinusoid->frequency_error_hz = error_hz;
      tap.sinusoid->decay_per_s = 12.0;
      tap.sinusoid->explained = 0.8;
      found.taps.push_back(tap);
    }
    return found;
  };
  const auto different = found_of({199.0, 415.0, 201.0, 413.0}, 0.1);
  CHECK_FALSE(runner::sinusoid_law(different, {}));
  CHECK_THAT(runner::why_no_sinusoid(different), Contains("200, 414 Hz"));
  for (const auto& one : {found_of({190.0, 199.0, 208.0, 217.0}, 0.1),  // they scatter
                          found_of({190.0, 210.0, 190.0, 210.0}, 10.0)}) {
    CHECK(runner::sinusoid_law(one, {}));
    CHECK(runner::why_no_sinusoid(one).empty());
  }
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

TEST_CASE("what was found of an orthotropic material is pasted as one, all moduli in proportion",
          "[runner][identify]") {
  runner::TapIdentification found;
  found.modes.emplace_back();
  found.modes.front().frequency_hz.value = 120.0;
  found.modes.front().damping_ratio.value = 0.01;
  found.agreed = {0};
  protocols::Material spruce;
  spruce.youngs_modulus_pa = 1e10;
  spruce.density_kg_per_m3 = 420.0;
  spruce.orthotropy =
      core::Orthotropy{{1.0, 0.07, 0.04}, {0.37, 0.42, 0.47}, {0.06, 0.055, 0.0035}, {0, 0, 0.5}};
  found.model.emplace();
  found.model->material = std::make_shared<const protocols::Material>(spruce);
  found.model->material_name = "spruce";
  found.model->update.emplace();
  found.model->update->youngs_modulus_pa.value = 1.1e10;
  const std::string yaml = runner::yaml_of(found);
  CHECK_THAT(yaml, Contains("youngs_moduli_pa: [1.1e+10, 7.7e+08, 4.4e+08]") &&
                       Contains("shear_moduli_pa: [6.6e+08, 6.05e+08, 3.85e+07]") &&
                       Contains("poissons_ratios: [0.37, 0.42, 0.47]") &&
                       Contains("axes_rotation_rad: [0, 0, 0.5]") &&
                       !Contains("youngs_modulus_pa"));
}

namespace {
constexpr const char* free_beam = R"(format: tapstudy/1
title: A free beam
finger: {mass_kg: 0.0058, stiffness_n_per_m: 300, damping_n_s_per_m: 3}
rendering: {rate_hz: 10000, penalty_stiffness_n_per_m: 3000, band_limit_hz: 2500}
placement: {origin_m: [0, 0, 0], lateral_scale: 1}
materials:
  steel: {youngs_modulus_pa: 2.0e11, poissons_ratio: 0.3, density_kg_per_m3: 7800, damping: {ratio: 0.01}}
plates:
  beam: {size_m: [0.3, 0.02, 0.005], mesh: {order: 2, max_tet_volume_m3: 2.0e-6}, fixations: []}
tapping_points_m: {end: [0.14, 0.0]}
stimuli:
  beam: {plate: beam, material: steel, technique: fem}
)";
runner::ModelComparison compared(const std::vector<double>& measured_hz,
                                 const std::vector<Eigen::Vector2d>& places_m, double from_hz) {
  const testing::TempDirectory directory;
  testing::write(directory / "beam.yaml", free_beam);
  runner::MeasuredModes measured{{}, {}, places_m, from_hz};
  for (const double hz : measured_hz) {
    measured.frequencies_hz.push_back({hz, 5e-4 * hz, {0.999 * hz, 1.001 * hz}, {}});
  }
  return runner::compare_with_model(protocols::read_protocol(directory / "beam.yaml"), "beam",
                                    measured, 2400.0, {});
}
}  // namespace

TEST_CASE("modes that are matched far beyond their intervals, or beside others, are doubted",
          "[runner][identify]") {
  const std::vector<double> model_hz = compared({}, {}, 0.0).frequencies_hz;
  REQUIRE(model_hz.size() > 4);
  const Eigen::Vector2d end_m{0.14, 0.0};
  const std::vector<double> alike{1.1 * model_hz[0], 1.1 * model_hz[1], 1.1 * model_hz[2]};
  CHECK(compared(alike, {end_m}, 0.0).doubts.empty());
  // of a free beam bent about its other axis nothing is seen from above
  const std::vector<double> others{0.97 * model_hz[1], 1.03 * model_hz[2]};
  const auto misfitted = compared(others, {}, 0.0);
  REQUIRE(misfitted.doubts.size() == 1);
  CHECK_THAT(misfitted.doubts.front(), Contains("3.0 %") && Contains("its modes 1 are skipped"));
  const std::vector<double> higher{model_hz[2], model_hz[3]};
  CHECK(compared(higher, {}, 0.0).doubts.empty());
  CHECK(compared(higher, {end_m}, 1.01 * model_hz[1]).doubts.empty());
  runner::TapIdentification found;
  found.modes.resize(2);
  found.agreed = {0, 1};
  found.model = compared(higher, {end_m}, 0.0);
  REQUIRE(found.model->doubts.size() == 1);
  CHECK_THAT(found.model->doubts.front(), Contains("modes 1") && Contains("what was tapped"));
  CHECK_THAT(runner::yaml_of(found), Contains("# CAUTION: " + found.model->doubts.front() + "\n"));
}

TEST_CASE("a tap whose energy has mostly died before its decay is taken names --skip",
          "[runner][identify]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.csv";
  const double damping_ratio = GENERATE(0.01, 0.08);
  // e^(-2 zeta omega t) of a mode's energy is left after t: 0.90 and 0.44 after 2 ms
  const double left = std::exp(-2.0 * damping_ratio * 2.0 * std::numbers::pi * 410.0 * 0.002);
  const analysis::Recording recording = testing::planted_recording(
      {{{410.0, damping_ratio}}, {{120.0, 0.03}, 0.1}}, {0.4, 1.7, 3.0}, 3000.0, 4.3, 1e-3, 5);
  std::string text = "acc\n";
  for (const double sample : recording.samples) {
    text += fmt::format("{:.7g}\n", sample);
  }
  testing::write(file, text);
  runner::TapQuestion question;
  question.recordings = {file};
  question.reading.rate_hz = 3000.0;
  question.band = analysis::Band{20.0, 600.0};
  runner::Progress progress{"identifying"};
  const std::string remarks =
      fmt::format("{}", fmt::join(runner::identify_taps(question, progress).remarks, "\n"));
  CAPTURE(remarks, left);
  CHECK((remarks.find("--skip") != std::string::npos) == (left < 0.5));
}

TEST_CASE("what was noticed about the taps stands in what is pasted, as comments",
          "[runner][identify]") {
  runner::TapIdentification found;
  found.others = {"11 components below 40 Hz: hum or handling"};
  found.remarks = {"9 of 23 taps: cut at the next one (taps\nof oak.wav)", "modes at 50 Hz: hum?"};
  const std::string yaml = runner::yaml_of(found);
  CHECK_THAT(yaml, Contains("# not listed: 11 components") && Contains("# 9 of 23 taps: cut") &&
                       Contains("# modes at 50 Hz"));
  std::istringstream lines{yaml};
  for (std::string line; std::getline(lines, line);) {
    CHECK(line.starts_with('#'));
  }
}
