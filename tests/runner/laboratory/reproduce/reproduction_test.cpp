// Judgements follow from numbers by the stated rule, and every format says the same.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <sstream>

#include "analysis/report/document/cells.hpp"
#include "analysis/report/document/formats.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "runner/laboratory/reproduce/claims.hpp"
#include "runner/laboratory/reproduce/discrimination.hpp"
#include "runner/laboratory/reproduce/mode_shapes.hpp"
#include "runner/laboratory/reproduce/paper_protocols.hpp"
#include "runner/laboratory/reproduce/reproduction_report.hpp"
#include "runner/laboratory/reproduce/tap_responses.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/reference_programs.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::runner;

namespace {
Method method_that(bool confirms) {
  return {confirms ? "good" : "bad", "tapstudy modes x", {at_most(confirms ? 2.0 : 0.0, "m", 1.0)}};
}

Reproduction made_up() {
  Claim odd{.name = "odd", .section = "section <9>", .statement = "a < b & \"c\"", .rule = "r"};
  odd.methods = {{"first",
                  "tapstudy tap a&b",
                  {at_least(1.5, "one & only", 1.25, "mm"), shown("seen", 1e-7, "µm"),
                   at_most(3.0, "none", std::nan(""))}},
                 {"second", "tapstudy modes", {at_most(3.0, "small", 2.0, "%")}}};
  odd.findings = {shown("found", 12345.678, "Hz")};
  odd.remarks = {"a remark"};
  Reproduction reproduction;
  reproduction.seed = std::numeric_limits<std::uint64_t>::max();
  reproduction.groups = {{"A group", {odd}}};
  reproduction.not_reproducible = {{"section 1", "what", "why & how"}};
  return reproduction;
}

template <class Write>
std::string written(const Write& write, const Reproduction& reproduction) {
  std::ostringstream out;
  write(out, reproduction);
  return out.str();
}
bool says(const std::string& page, const std::string& words) {
  return page.find(analysis::escaped(words)) != std::string::npos;
}
}  // namespace

TEST_CASE(
    "a claim is true if every method that judges confirms it, false if none does, else it "
    "depends",
    "[runner][reproduction]") {
  for (unsigned int which = 0; which < 8; ++which) {
    Claim claim;
    for (unsigned int i = 0; i < 3; ++i) {
      claim.methods.push_back(method_that((which >> i & 1U) != 0));
    }
    CHECK(name(claim.verdict()) == (which == 7 ? "true" : which == 0 ? "false" : "depends"));
    const auto verdict = claim.verdict();
    const Method own_number{"own", "tapstudy report", {shown("the paper's number", 2.0)}};
    claim.methods.push_back(own_number);
    CHECK(claim.verdict() == verdict);
    claim.unknown_input = "the force";
    CHECK(name(claim.verdict()) == "depends");
    CHECK(claim.reasons().front() == "Depends on what the paper does not give: the force.");
    claim.methods = {own_number};
    CHECK(name(claim.verdict()) == "shown");
  }
}

TEST_CASE("a faster machine, and a formula that tapstudy took from the paper, judge nothing",
          "[runner][reproduction]") {
  Bench bench;
  bench.effort = Effort::quick;
  const std::vector<Claim> timed = step_time(bench);
  REQUIRE(timed.size() == 1);
  CHECK(name(timed.front().verdict()) == "shown");
  CHECK(timed.front().methods.size() == 2);
}

TEST_CASE("a measure holds up to its limit; what is no number keeps none",
          "[runner][reproduction]") {
  const double limit = 0.1;
  const double beyond = std::nextafter(limit, 1.0);
  CHECK(at_most(limit, "m", limit).holds());
  CHECK_FALSE(at_most(limit, "m", beyond).holds());
  CHECK(at_least(limit, "m", limit).holds());
  CHECK_FALSE(at_least(beyond, "m", limit).holds());
  CHECK_FALSE(at_most(limit, "m", std::nan("")).holds());
  CHECK_FALSE(at_least(limit, "m", std::nan("")).holds());
  CHECK(within(limit, beyond, "m", limit).holds());
  CHECK(within(limit, beyond, "m", beyond).holds());
  CHECK_FALSE(within(limit, beyond, "m", 0.0).holds());
  CHECK_FALSE(within(limit, beyond, "m", 0.2).holds());
  CHECK_FALSE(within(limit, beyond, "m", std::nan("")).holds());
  CHECK(shown("m", std::nan("")).holds());
}

TEST_CASE("one measure that does not hold refutes its method, and is named",
          "[runner][reproduction]") {
  Claim claim;
  claim.methods = {{"way", "", {at_most(1.0, "fits", 0.5), at_most(1.0, "too much", 2.0, "mm")}}};
  CHECK_FALSE(claim.methods.front().confirms());
  REQUIRE(claim.reasons().size() == 1);
  CHECK(claim.reasons().front() == "Does not hold way: too much is 2 mm, not at most 1 mm.");
}

TEST_CASE("the page and JSON say the same", "[runner][reproduction]") {
  const Reproduction reproduction = made_up();
  const std::string page = written(write_html, reproduction);
  const auto json = nlohmann::json::parse(written(write_json, reproduction));
  REQUIRE(json["claims"].size() == 1);
  const auto& claim = json["claims"][0];
  CHECK(claim["verdict"] == "depends");
  CHECK(page.find("<span class=\"verdict depends\">depends</span>") != std::string::npos);
  CHECK(page.find("id=\"" + claim["name"].get<std::string>() + '"') != std::string::npos);
  for (const char* const key : {"section", "statement", "rule"}) {
    INFO(key);
    CHECK(says(page, claim[key]));
  }
  CHECK(claim["reasons"].size() == 2);
  for (const auto& reason : claim["reasons"]) {
    CHECK(says(page, reason));
  }
  CHECK(says(page, claim["remarks"][0]));
  CHECK(says(page, json["command"]));
  CHECK(says(page, json["not_reproducible"][0]["why"]));
  for (const auto& method : claim["methods"]) {
    CHECK(says(page, method["command"]));
    for (const auto& measure : method["measures"]) {
      const double value =
          measure["value"].is_null() ? std::nan("") : measure["value"].get<double>();
      const std::string unit = measure["unit"];
      CHECK(page.find(analysis::escaped_numbers(measure["name"]) +
                      "</th><td data-heading=\"value\">" +
                      analysis::escaped_numbers(analysis::rounded(value) +
                                                (unit.empty() ? "" : " " + unit)) +
                      "</td>") != std::string::npos);
    }
  }
  CHECK(json["seed"].get<std::uint64_t>() == reproduction.seed);
  CHECK(claim["findings"][0]["value"] == 12345.678);
  CHECK(claim["methods"][0]["measures"][2]["holds"] == false);
  CHECK(claim["methods"][0]["measures"][1]["at_least"].is_null());
}

TEST_CASE("the page needs nothing beside it", "[runner][reproduction]") {
  const std::string page = written(write_html, made_up());
  for (const char* const reference :
       {"http:", "https:", "src=", "@import", "url(", "<link", "<script"}) {
    INFO(reference);
    CHECK(page.find(reference) == std::string::npos);
  }
}

// What claims are measured with: laws of the parts, and the commands that the claims name.
namespace {
// The printed plates alone, which take no time to build.
struct PrintedBench : Bench {
  PrintedBench() {
    plates.resize(1);
    REQUIRE(plates.front().name == method::printed);
  }
};
const Claim& claim_of(const std::vector<Claim>& claims, const std::string& name) {
  return *std::ranges::find(claims, name, &Claim::name);
}
double value_of(const Method& method, const std::string& name) {
  const auto found = std::ranges::find(method.measures, name, &Measure::name);
  REQUIRE(found != method.measures.end());
  return found->value;
}
// The program's name left out, paths made those of the sources.
std::vector<std::string> arguments_of(const std::string& command) {
  std::istringstream stream{command};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) {
    words.push_back(word.starts_with("protocols/") ? testing::source(word) : word);
  }
  REQUIRE(words.front() == "tapstudy");
  words.erase(words.begin());
  return words;
}
std::vector<core::TraceSample> trace_with(double frequency_hz, double amplitude_n) {
  std::vector<core::TraceSample> trace;
  for (int i = 0; i < 300; ++i) {
    core::TraceSample sample{};
    sample.t_ns = std::int64_t{1'000'000} * i;
    sample.impact = i == 50;
    sample.penalty_n = i < 50 ? 0.0 : 2.0;
    sample.vibration_n =
        i < 50 ? 0.0 : amplitude_n * std::sin(2.0 * std::numbers::pi * frequency_hz * 1e-3 * i);
    trace.push_back(sample);
  }
  return trace;
}
}  // namespace

TEST_CASE("the protocols within the program are the shipped files", "[runner][reproduction]") {
  for (const std::string folder : {"paper", "recommended"}) {
    for (const auto& entry : std::filesystem::directory_iterator{testing::shipped(folder)}) {
      const std::string name = "protocols/" + folder + "/" + entry.path().filename().string();
      INFO(name);
      CHECK(shipped_text(name) == testing::contents(entry.path()));
    }
  }
  CHECK_THROWS_AS(shipped_text("protocols/paper/none.yaml"), core::InvalidInput);
}

// 250 ticks from the impact on hold whole waves of these frequencies.
TEST_CASE("a wave below 100 Hz is low-frequency vibration, one above is high",
          "[runner][reproduction]") {
  const double amplitude_n = 0.7;
  const auto [hz, is_low] = GENERATE(std::pair{40.0, true}, std::pair{96.0, true},
                                     std::pair{104.0, false}, std::pair{248.0, false});
  const TapForce force = tap_force(trace_with(hz, amplitude_n), 1000.0);
  INFO(hz);
  CHECK((is_low ? force.low_n : force.high_n) == Approx(force.vibration_n).epsilon(1e-9));
  CHECK((is_low ? force.high_n : force.low_n) < 1e-9);
  CHECK(force.penalty_n == 2.0);
  CHECK(force.t_s.front() == 0.0);
  CHECK_THROWS_AS(tap_force({}, 1000.0), core::InvalidInput);
}

TEST_CASE("a map is red where it is largest in magnitude and blue where it rests",
          "[runner][reproduction]") {
  analysis::ColourMap map;
  map.columns = 3;
  map.rows = 1;
  map.panels = {{"one", {0.0, 5.0, -2.0}}, {"two", {-1.0, 5.0, 0.0}}};
  const std::vector<std::string> drawn = colour_svgs(map);
  REQUIRE(drawn.size() == 2);
  CHECK(drawn[0].find("#2166c8\" d=\"M0 0h1v1h-1z\"") != std::string::npos);
  CHECK(drawn[0].find("#cd182b\" d=\"M1 0h1v1h-1z\"") != std::string::npos);
  map.panels[0].values[2] = -5.0;
  CHECK(colour_svgs(map)[0].find("#cd182b\" d=\"M1 0h1v1h-1zM2 0h1v1h-1z\"") != std::string::npos);
}

TEST_CASE(
    "the force on a finger takes away its speed, and a heavy plate is felt as a rigid surface",
    "[runner][reproduction]") {
  const protocols::Protocol protocol =
      with_real_finger(shipped_protocol("protocols/paper/plate_model.yaml"));
  const auto stimulus = stimulus_with(protocol, protocol.stimulus("aluminium"));
  const RealTap rigid = real_tap(nullptr, stimulus.rendering, {0.0, 0.0}, 0.16);
  CHECK(rigid.finger_m_s2.sum() / real_rate_hz == Approx(0.9).epsilon(1e-3));  // to rest
  CHECK(rigid.plate_m_s2.isZero(0.0));

  core::PlateSpec heavy = plate_spec(protocol, stimulus);
  heavy.material.density_kg_per_m3 *= 1e4;
  heavy.material.youngs_modulus_pa *= 1e4;  // the same frequencies
  const core::VibratingPlate plate{core::build_plate_model(heavy).modal};
  const core::VibratingPlate light{core::build_plate_model(plate_spec(protocol, stimulus)).modal};
  const auto difference_n = [&](const core::VibratingPlate& felt) {
    return (real_tap(&felt, stimulus.rendering, {0.0, 0.0}, 0.16).force_n - rigid.force_n).norm();
  };
  CHECK(difference_n(plate) == Approx(1e-4 * difference_n(light)).epsilon(0.05));
}

TEST_CASE("levels add up in power", "[runner][reproduction]") {
  FeltTap tap{};
  CHECK(level_db(tap) < -100.0);
  tap.level_db[3] = 20.0;
  CHECK(level_db(tap) == Approx(10.0 * std::log10(99.0)));
  tap.level_db[20] = 20.0;
  CHECK(level_db(tap) == Approx(10.0 * std::log10(99.0 + 99.0)));
}

// Every table of these totals, by its multinomial probability.
TEST_CASE("the test by drawing agrees with that by enumeration", "[runner][reproduction]") {
  const std::string enumerate = R"(
import itertools
from scipy.stats import multinomial
def rows(n, p):
  return [multinomial.pmf(c, n, p) for c in itertools.product(range(n + 1), repeat=len(p)) if sum(c) == n]
first, second = [3, 1, 2], [0, 4, 1]
p, q = [0.5, 0.2, 0.3], [0.3, 0.3, 0.4]
observed = multinomial.pmf(first, 6, p) * multinomial.pmf(second, 5, q)
out(sum(a * b for a in rows(6, p) for b in rows(5, q) if a * b <= observed * (1 + 1e-9)))
out(sum(a for a in rows(6, p) if a <= multinomial.pmf(first, 6, p) * (1 + 1e-9)))
)";
  const std::vector<double> exact = testing::python_numbers(enumerate);
  const analysis::CountTable counts{{3, 1, 2}, {0, 4, 1}};
  const Probabilities probabilities{{0.5, 0.2, 0.3}, {0.3, 0.3, 0.4}};
  const double four_errors = 4.0 * std::sqrt(0.25 / 4000.0);
  CHECK(std::abs(multinomial_p(counts, {0, 1}, probabilities, 1) - exact.at(0)) < four_errors);
  CHECK(std::abs(multinomial_p(counts, {0}, probabilities, 1) - exact.at(1)) < four_errors);
}

TEST_CASE("of a true model known from few answers one table in twenty is rejected, not more",
          "[runner][reproduction][slow]") {
  constexpr int tables = 100;
  const std::vector<double> truth{0.55, 0.25, 0.15, 0.05};
  core::Rng rng{3};
  const auto row_of = [&](int answers) {
    std::vector<std::int64_t> row(truth.size(), 0);
    for (int answer = 0; answer < answers; ++answer) {
      double left = rng.uniform();
      std::size_t j = 0;
      while (j + 1 < row.size() && left >= truth[j]) {
        left -= truth[j++];
      }
      ++row[j];
    }
    return row;
  };
  int rejected = 0;
  int by_exact = 0;
  for (int i = 0; i < tables; ++i) {
    const analysis::CountTable counts{row_of(20), row_of(20)};
    const analysis::CountTable answers{row_of(40), row_of(40)};
    const auto seed = static_cast<std::uint64_t>(i);
    rejected += predictive_p(counts, {0, 1}, answers, seed) < 0.05 ? 1 : 0;
    by_exact += multinomial_p(counts, {0, 1}, probabilities_of(answers), seed) < 0.05 ? 1 : 0;
  }
  CHECK(rejected <= 0.05 * tables + 3.3 * std::sqrt(tables * 0.05 * 0.95));
  CHECK(rejected > 0);
  CHECK(by_exact > 2 * rejected);  // which takes them for known
}

TEST_CASE("the likeliest probabilities of a table are its own shares", "[runner][reproduction]") {
  const analysis::CountTable counts{{30, 10, 0}, {5, 5, 30}};
  const Probabilities own = probabilities_of(counts);
  for (const auto& row : own) {
    CHECK(std::accumulate(row.begin(), row.end(), 0.0) == Approx(1.0));
  }
  CHECK(own[0][2] == Approx(0.5 / 41.5));
  const Probabilities other = probabilities_of({{20, 20, 0}, {10, 5, 25}});
  CHECK(log_likelihood(counts, {0, 1}, own) > log_likelihood(counts, {0, 1}, other));
  CHECK(log_likelihood(counts, {0, 1}, own) ==
        Approx(log_likelihood(counts, {0}, own) + log_likelihood(counts, {1}, own)));
}

TEST_CASE("the mesh of a claim is the one that its command shows", "[runner][reproduction]") {
  PrintedBench bench;
  const std::vector<Claim> claims = plate_model(bench);
  for (const auto& [name, measure, key] :
       {std::tuple{"tetrahedra", "tetrahedra", "elements"},
        std::tuple{"all_modes", "free degrees of freedom", "dof"}}) {
    const Method& method = claim_of(claims, name).methods.front();
    std::vector<std::string> arguments = arguments_of(method.command);
    arguments.emplace_back("--json");
    const auto shown_by = nlohmann::json::parse(testing::tapstudy(arguments).standard_output);
    CHECK(value_of(method, measure) == shown_by[key].get<double>());
  }
}

// NumPy's transform of what the command writes.
TEST_CASE("the forces of a claim are those that its command writes", "[runner][reproduction]") {
  const std::string shares = R"(
import csv, sys
import numpy
rows = list(csv.DictReader(open(sys.argv[1])))
first = next(i for i, row in enumerate(rows) if row["impact"] == "1")
force = numpy.array([float(row["vibration_n"]) for row in rows[first:]])
penalty = max(abs(float(row["penalty_n"])) for row in rows[first:])
spectrum = numpy.fft.rfft(force)
spectrum[numpy.fft.rfftfreq(len(force), 1e-3) >= 100.0] = 0.0
low = numpy.fft.irfft(spectrum, len(force))
print(*(repr(float(100.0 * abs(part).max() / penalty)) for part in (force, low, force - low)))
)";
  const testing::TempDirectory directory;
  PrintedBench bench;
  const std::vector<Claim> claims = feedback_forces(bench);
  for (const auto& [name, part] : {std::pair{"p1_no_vibration", 0}, std::pair{"p3_two_large", 1},
                                   std::pair{"p2_high_modes_seen", 2}}) {
    const Method& method = claim_of(claims, name).methods.front();
    const std::string file = directory / (std::string{name} + ".csv");
    std::vector<std::string> arguments = arguments_of(method.command);
    REQUIRE(arguments.back() == "tap.csv");
    arguments.back() = file;
    REQUIRE(testing::tapstudy(arguments).exit_code == 0);
    const auto found = testing::run_program({"/usr/bin/python3", "-c", shares, file});
    INFO(name << found.standard_error);
    std::istringstream words{found.standard_output};
    std::array<double, 3> expected{};
    for (double& value : expected) {
      words >> value;
    }
    CHECK(method.measures.front().value ==
          Approx(expected.at(static_cast<std::size_t>(part))).epsilon(1e-9));
  }
}
