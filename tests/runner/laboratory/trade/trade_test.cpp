#include "runner/laboratory/trade/trade.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/random/rng.hpp"
#include "core/techniques/technique.hpp"
#include "core/tick/tap_renderer.hpp"
#include "device/hand/penalty_limit.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "runner/laboratory/trade/rendering_accuracy.hpp"
#include "runner/laboratory/trade/stability.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::runner;

namespace {
// Of a string fixed at both ends: sines.
SampledModes string_modes(const Eigen::ArrayXd& frequency_hz) {
  SampledModes modes{frequency_hz, Eigen::MatrixXd{60, frequency_hz.size()}};
  for (Eigen::Index i = 0; i < 60; ++i) {
    for (Eigen::Index mode = 0; mode < frequency_hz.size(); ++mode) {
      modes.shape(i, mode) =
          std::sin(M_PI * (static_cast<double>(i) + 0.5) / 60.0 * static_cast<double>(mode + 1));
    }
  }
  return modes;
}
SampledModes without_mode(const SampledModes& modes, Eigen::Index lost) {
  const Eigen::Index rest = modes.frequency_hz.size() - lost - 1;
  SampledModes fewer{Eigen::ArrayXd{lost + rest}, Eigen::MatrixXd{60, lost + rest}};
  fewer.frequency_hz << modes.frequency_hz.head(lost), modes.frequency_hz.tail(rest);
  fewer.shape << modes.shape.leftCols(lost), modes.shape.rightCols(rest);
  return fewer;
}
}  // namespace

TEST_CASE("a mode that rings where it should has no frequency error", "[runner][trade]") {
  const SampledModes modes = string_modes(Eigen::ArrayXd::LinSpaced(4, 50.0, 200.0));
  SampledModes sharper = modes;
  sharper.frequency_hz *= 1.1;
  CHECK(match_modes(modes, modes, 250.0).frequency_error == 0.0);
  CHECK(match_modes(modes, sharper, 250.0).frequency_error == Approx(0.1));
  CHECK((numerical_frequency_hz(modes.frequency_hz, core::Integrator::exact, 1000.0) ==
         modes.frequency_hz)
            .all());
}

TEST_CASE("a lost mode is missed, not taken for its neighbour of another shape",
          "[runner][trade]") {
  const SampledModes modes = string_modes(Eigen::ArrayXd::LinSpaced(4, 100.0, 130.0));
  const ModeMatch lost = match_modes(modes, without_mode(modes, 1), 200.0);
  CHECK(lost.missing == 1);
  CHECK(lost.extra == 0);
  CHECK(lost.frequency_error == Approx(200.0 / 110.0 - 1.0));
  const ModeMatch added = match_modes(without_mode(modes, 1), modes, 200.0);
  CHECK(added.missing == 0);
  CHECK(added.extra == 1);
  CHECK(added.frequency_error == 0.0);
}

TEST_CASE("any two mixtures of a double mode are that double mode", "[runner][trade]") {
  const SampledModes modes = string_modes(Eigen::Array3d{80.0, 100.0, 100.0});
  const double angle = GENERATE(0.0, 0.3, M_PI / 4.0, 1.2);
  SampledModes mixed = modes;
  mixed.shape.col(1) = std::cos(angle) * modes.shape.col(1) + std::sin(angle) * modes.shape.col(2);
  mixed.shape.col(2) = std::cos(angle) * modes.shape.col(2) - std::sin(angle) * modes.shape.col(1);
  const ModeMatch match = match_modes(modes, mixed, 200.0);
  CHECK(match.missing == 0);
  CHECK(match.extra == 0);
  CHECK(match.frequency_error == 0.0);
}

TEST_CASE("twice the decay rate is a decay error of its own, whatever the level",
          "[runner][trade]") {
  const auto ring = [](double amplitude, double decay_per_s) {
    const Eigen::ArrayXd t_s = Eigen::ArrayXd::LinSpaced(300, 0.0, 0.299);
    return Forces{amplitude * (-decay_per_s * t_s).exp() * (2.0 * M_PI * 100.0 * t_s).sin()};
  };
  CHECK(decay_error_db(ring(1.0, 20.0), ring(0.5, 20.0), 1000.0, 400.0) ==
        Approx(0.0).margin(1e-9));
  // energy after t_e beside the energy before: e^-2at_e / (1 - e^-2at_e), to the record's end
  const auto late_db = [](double a) {
    const double at_40ms = std::exp(-2.0 * a * 0.04);
    return 10.0 * std::log10((at_40ms - std::exp(-2.0 * a * 0.3)) / (1.0 - at_40ms));
  };
  CHECK(decay_error_db(ring(1.0, 20.0), ring(1.0, 40.0), 1000.0, 400.0) ==
        Approx(late_db(20.0) - late_db(40.0)).epsilon(0.02));
  // what lies beyond the band is not judged, nor what has gone
  CHECK(decay_error_db(ring(1.0, 20.0), ring(1.0, 40.0), 1000.0, 50.0) < 4.0);
  CHECK(decay_error_db(ring(1.0, 120.0), ring(1.0, 200.0), 1000.0, 400.0) < 1.0);
  CHECK(decay_error_db(ring(1.0, 20.0), Forces::Zero(300, 1), 1000.0, 400.0) == 60.0);
}

TEST_CASE("Newmark rings at the frequency that its own zero crossings show", "[runner][trade]") {
  constexpr double dt_s = 1e-3;
  for (const double hz : {30.0, 100.0, 300.0}) {
    CAPTURE(hz);
    const core::StateTransition step = core::newmark_transition(2.0 * M_PI * hz, 0.0, dt_s);
    double displacement = 0.0;
    double velocity = 1.0;
    int crossings = 0;
    constexpr int ticks = 200'000;
    for (int tick = 0; tick < ticks; ++tick) {
      const double before = displacement;
      displacement = step.qq * before + step.qv * velocity;
      velocity = step.vq * before + step.vv * velocity;
      crossings += before * displacement < 0.0 ? 1 : 0;
    }
    const Eigen::ArrayXd told = numerical_frequency_hz(Eigen::ArrayXd::Constant(1, hz),
                                                       core::Integrator::newmark, 1.0 / dt_s);
    CHECK(told[0] == Approx(0.5 * crossings / (ticks * dt_s)).epsilon(1e-3));
  }
}

TEST_CASE("a mode lost beyond the band is at least as wrong as the band's edge",
          "[runner][trade]") {
  const SampledModes reference = string_modes(Eigen::Array2d{100.0, 200.0});
  const SampledModes found = without_mode(reference, 1);
  CHECK(match_modes(reference, found, 300.0).frequency_error == Approx(0.5));
  // what the reference has beyond the band is not asked for
  CHECK(match_modes(reference, found, 150.0).frequency_error == 0.0);
  CHECK(match_modes(reference, found, 150.0).missing == 0);
}

TEST_CASE("the level of twice the force is 6.02 dB off", "[runner][trade]") {
  const Forces forces = Forces::Random(300, 3);
  const auto error_db = [&](const Forces& found) {
    return level_error_db(forces, found, 1000.0, 400.0);
  };
  CHECK(error_db(forces) == 0.0);
  CHECK(error_db(2.0 * forces) == Approx(6.0206).epsilon(1e-4));
  CHECK(error_db(-forces) == 0.0);
  CHECK(force_error(forces, -forces) == Approx(2.0));
}

TEST_CASE("a third octave that is lost or too loud is not made good by the others",
          "[runner][trade]") {
  const auto tone = [](double hz, double amplitude) {
    Forces force{300, 1};
    for (Eigen::Index i = 0; i < 300; ++i) {
      force(i, 0) = amplitude * std::sin(2.0 * M_PI * hz * static_cast<double>(i) / 1000.0);
    }
    return force;
  };
  const Forces both = tone(100.0, 1.0) + tone(200.0, 1.0);
  const auto error_db = [&](const Forces& found, double band_hz) {
    return level_error_db(both, found, 1000.0, band_hz);
  };
  CHECK(error_db(tone(100.0, std::sqrt(2.0)), 400.0) == 60.0);  // as loud as both
  CHECK(error_db(tone(100.0, 1.0), 150.0) == Approx(0.0).margin(1e-6));
  CHECK(error_db(tone(100.0, 1.0) + tone(200.0, 0.5), 400.0) == Approx(6.0206).epsilon(1e-3));
}

TEST_CASE("one tapping point out of many decides the error", "[runner][trade]") {
  const Forces reference = Forces::Ones(10, 3);
  Forces found = reference;
  found.col(1) *= 1.25;
  CHECK(force_error(reference, found) == Approx(0.25));
}

TEST_CASE("a held output keeps slow vibration and loses that at the rate", "[runner][trade]") {
  const Eigen::ArrayXd hz = Eigen::Array3d{1e-3, 500.0, 1000.0};
  const Eigen::ArrayXd gain = held_gain(hz, 1000.0);
  CHECK(gain[0] == Approx(1.0));
  CHECK(gain[1] == Approx(2.0 / M_PI));
  CHECK(gain[2] == Approx(0.0).margin(1e-15));
}

TEST_CASE("a hand rests on a wall softer than its limit and chatters on a stiffer one",
          "[runner][stability]") {
  const core::HandBody hand;
  core::RenderSettings settings;
  const double limit = device::largest_stable_penalty_n_per_m(hand, settings.dt_s);
  for (const double part : {0.5, 0.95, 1.05, 2.0}) {
    settings.penalty_stiffness_n_per_m = part * limit;
    core::TapRenderer renderer = core::make_renderer(*core::find_technique("none"), settings,
                                                     core::PlateFace{0.3, 0.3}, nullptr);
    const auto seen = runner::tap_and_stay(renderer, hand, settings.dt_s, {});
    CAPTURE(part, seen.residual_oscillation);
    CHECK((seen.residual_oscillation > 0.1) == (part > 1.0));
  }
}

using runner::Evaluation;
using runner::Trade;
using testing::TempDirectory;

namespace {
Trade random_trade(std::uint64_t seed) {
  core::Rng rng{seed};
  Trade trade;
  trade.settings.resize(40);
  for (Evaluation& one : trade.settings) {
    one.cost_s = rng.uniform();
    one.force_error = 1.3 * rng.uniform();
    one.frequency_error = rng.uniform();
    one.level_error_db = 5.0 * rng.uniform();
  }
  runner::mark_pareto_front(trade);
  return trade;
}

bool surpasses(const Evaluation& a, const Evaluation& b) {
  return a.cost_s <= b.cost_s && a.force_error <= b.force_error &&
         (a.cost_s < b.cost_s || a.force_error < b.force_error);
}

std::string cantilever() {
  return R"(
format: tapstudy/1
title: A block held by one side
finger: {mass_kg: 0.058, stiffness_n_per_m: 300, damping_n_s_per_m: 3}
rendering: {rate_hz: 1000, penalty_stiffness_n_per_m: 3000, band_limit_hz: 400, integrator: newmark}
placement: {origin_m: [0, 0, 0], lateral_scale: 0.1}
materials:
  soft:
    youngs_modulus_pa: 4.0e8
    density_kg_per_m3: 1000
    poissons_ratio: 0.3
    damping: {alpha_per_s: 20.0, beta_s: 1.0e-5}
plates:
  block:
    size_m: [0.3, 0.1, 0.04]
    mesh: {order: 1}
    fixations: [{region: side, side: left, axes: xyz}]
tapping_points_m: {tip: [0.1, 0.02]}
stimuli:
  block: {label: block, plate: block, material: soft, technique: fem}
  silent: {label: silent, plate: block, material: soft, technique: none}
)";
}
}  // namespace

TEST_CASE("on the front are all settings that none surpasses, and only those", "[runner][trade]") {
  const Trade trade = random_trade(GENERATE(1u, 2u, 3u));
  for (const Evaluation& one : trade.settings) {
    const bool is_surpassed = std::ranges::any_of(
        trade.settings, [&](const Evaluation& other) { return surpasses(other, one); });
    CHECK(one.is_on_front == (!is_surpassed && one.force_error < 1.0));
  }
}

TEST_CASE("the cheapest setting inside the tolerance is inside it, and none cheaper is",
          "[runner][trade]") {
  const Trade trade = random_trade(4);
  REQUIRE(trade.cheapest >= 0);
  const Evaluation& chosen = trade.settings.at(static_cast<std::size_t>(trade.cheapest));
  CHECK(chosen.frequency_error <= trade.tolerance.frequency);
  CHECK(chosen.level_error_db <= trade.tolerance.level_db);
  for (const Evaluation& one : trade.settings) {
    CHECK((one.cost_s >= chosen.cost_s || one.frequency_error > trade.tolerance.frequency ||
           one.level_error_db > trade.tolerance.level_db));
  }
}

TEST_CASE("by a reference that has not settled nothing is recommended", "[runner][trade]") {
  Trade trade = random_trade(4);
  trade.reference.moved_level_db = 1.0;
  runner::mark_pareto_front(trade);
  CHECK(trade.cheapest == -1);
}

TEST_CASE("trade finds what the elements, the band and the integrator cost in accuracy",
          "[runner][trade][slow]") {
  const TempDirectory directory;
  testing::write(directory / "study.yaml", cantilever());
  const auto run = testing::tapstudy({"trade", directory / "study.yaml", "--stimulus", "block",
                                      "--json", "--out", directory / "trade"});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  const auto json = nlohmann::json::parse(run.standard_output);
  // a side held whole settles
  CHECK(json["reference"]["moved_frequency"] < 0.01);
  // with the reference's own band
  const auto error = [&](int order, const std::string& integrator, double rate_hz) {
    double least = HUGE_VAL;
    for (const auto& one : json["settings"]) {
      if (one["order"] == order && one["integrator"] == integrator && one["rate_hz"] == rate_hz &&
          one["band_limit_hz"] == 800.0) {
        least = std::min(least, one["force_error"].get<double>());
      }
    }
    return least;
  };
  CHECK(error(2, "exact", 2000.0) < 0.5 * error(1, "exact", 2000.0));
  CHECK(error(2, "exact", 2000.0) < 0.5 * error(2, "newmark", 2000.0));
  CHECK(error(2, "newmark", 4000.0) < 0.5 * error(2, "newmark", 2000.0));
  CHECK(error(2, "exact", 4000.0) == Approx(error(2, "exact", 2000.0)).epsilon(1e-6));
  CHECK(std::ranges::count_if(json["settings"],
                              [](const auto& one) { return one["is_protocols"] == true; }) == 1);
  for (const auto& one : json["stability"]) {
    CAPTURE(one);
    CHECK(one["outcome"] != "FAILED");
    CHECK((one["outcome"] == "nothing tested") ==
          one["words"].get<std::string>().starts_with("0 modes"));
    if (one["property"] == "penalty_stiffness_n_per_m") {
      CHECK((one["outcome"] == "dies out") == (one["value"] < json["penalty_limit_n_per_m"]));
    }
    if (one["property"] == "damping_ratio") {
      CHECK((one["outcome"] == "persists") == (one["value"] == 0.0));
    }
  }
  // so light that its first mode is far above the band
  CHECK(std::ranges::any_of(json["stability"], [](const auto& one) {
    return one["property"] == "density_kg_per_m3" && one["value"] == 1.0 &&
           one["outcome"] == "nothing tested";
  }));
  for (const char* const file : {"trade.csv", "trade.json", "trade.svg", "stability.csv"}) {
    CHECK(std::filesystem::file_size(directory / ("trade/" + std::string{file})) > 100);
  }
}

TEST_CASE("a setting that finds no mode is refused in words, the protocol's own too",
          "[runner][trade][slow]") {
  const TempDirectory directory;
  testing::write(directory / "study.yaml",
                 testing::replaced(cantilever(), "band_limit_hz: 400", "band_limit_hz: 30"));
  const protocols::Protocol protocol = protocols::read_protocol(directory / "study.yaml");
  const Trade trade = runner::measure_trade(protocol, protocol.stimulus("block"), {});
  CHECK(!trade.settings.empty());
  // seven meshes, below 15 and below 30 Hz; linear elements lock so that some miss 60 Hz too
  CHECK(std::ranges::count_if(trade.refused, [](const runner::Refused& one) {
          return one.band_limit_hz <= 30.0;
        }) == 14);
  CHECK(std::ranges::count(trade.refused, true, &runner::Refused::is_protocols) == 1);
  for (const runner::Refused& one : trade.refused) {
    CHECK_THAT(one.words, Contains("no mode"));
  }
}

TEST_CASE("nothing is traded where nothing vibrates", "[runner][trade]") {
  const TempDirectory directory;
  testing::write(directory / "study.yaml", cantilever());
  const auto run = testing::tapstudy({"trade", directory / "study.yaml", "--stimulus", "silent"});
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.standard_error, Contains("technique 'none'"));
}

TEST_CASE("trade refuses what it cannot write or compare with before it measures",
          "[runner][trade]") {
  const TempDirectory directory;
  testing::write(directory / "study.yaml", cantilever());
  testing::write(directory / "trade.svg", "kept");
  const std::vector<std::string> command{"trade", directory / "study.yaml", "--stimulus", "block"};
  const std::vector<std::vector<std::string>> additions{{"--out", directory / "."},
                                                        {"--out", directory / "study.yaml"},
                                                        {"--frequency-tolerance", "nan"},
                                                        {"--level-tolerance-db", "0"}};
  for (const auto& more : additions) {
    std::vector<std::string> line = command;
    line.insert(line.end(), more.begin(), more.end());
    const auto run = testing::tapstudy(line);
    CAPTURE(more, run.standard_error);
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.standard_error, !Contains("iterating"));
  }
  CHECK(testing::contents(directory / "trade.svg") == "kept");
}

TEST_CASE("two damping ratios of a body with one mode are traded as that one ratio",
          "[runner][trade][slow]") {
  const TempDirectory directory;
  std::string text = testing::replaced(cantilever(), "band_limit_hz: 400", "band_limit_hz: 50");
  text = testing::replaced(text, "{alpha_per_s: 20.0, beta_s: 1.0e-5}",
                           "{first_ratio: 0.02, last_ratio: 0.02}");
  testing::write(directory / "study.yaml", text);
  const protocols::Protocol protocol = protocols::read_protocol(directory / "study.yaml");
  const Trade trade =
      runner::measure_trade(protocol, protocol.stimulus("block"), {}, runner::Effort::quick);
  CHECK(trade.reference.modes > 0);
}
