#include "runner/accuracy/trade.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/rng.hpp"
#include "protocols/read_protocol.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
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
    if (one["property"] == "penalty_stiffness_n_per_m") {
      CHECK((one["outcome"] == "dies out") == (one["value"] < json["penalty_limit_n_per_m"]));
    }
    if (one["property"] == "damping_ratio") {
      CHECK((one["outcome"] == "persists") == (one["value"] == 0.0));
    }
  }
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
