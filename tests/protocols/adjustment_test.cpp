// How runs of the method of adjustment are planned, and what is refused.
#include <algorithm>
#include <set>

#include "core/error.hpp"
#include "protocols/read_protocol.hpp"
#include "protocols/schedule.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
std::string with_block(const std::string& keys, int repetitions = 12) {
  std::string text = testing::contents(testing::source("tests/data/every_task.yaml"));
  const auto first = text.find("blocks:");
  text.replace(first, text.find("simulation:") - first,
               "blocks:\n  - name: adjustment\n    task: adjustment\n    question: Equal?\n"
               "    repetitions: " +
                   std::to_string(repetitions) + "\n" + keys);
  return testing::replaced(text, ", reference: one}", "}");
}
const std::string family = "    stimuli: [family]\n";
const std::string grid = "    settings: {from: 3, to: 6, count: 7}\n";

std::vector<double> starts_of(const std::string& text, std::uint64_t seed) {
  const protocols::Protocol protocol = protocols::parse_protocol(text, "study.yaml");
  std::vector<double> starts;
  for (const protocols::PlannedTrial& trial : make_schedule(protocol, seed, 0)) {
    starts.push_back(trial.alternatives.back().values.at("sinusoid_amplitude_n_s_per_m"));
  }
  return starts;
}
}  // namespace

TEST_CASE("half of the runs start below the standard and half above, never at it",
          "[protocols][tasks]") {
  for (const char* const standard : {"    standard: 4.5\n", "    standard: 3.2\n",
                                     "    standard: 5.9\n", "    reference: one\n"}) {
    const std::string text = with_block(family + grid + standard);
    const double middle = std::string{standard}.find("reference") == std::string::npos
                              ? std::stod(std::string{standard}.substr(14))
                              : 4.5;
    std::set<std::vector<double>> orders;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const auto starts = starts_of(text, seed);
      CAPTURE(standard, seed);
      CHECK(starts.size() == 12);
      CHECK(std::ranges::count_if(starts, [&](double start) { return start < middle; }) == 6);
      CHECK(std::ranges::count_if(starts, [&](double start) { return start > middle; }) == 6);
      orders.insert(starts);
    }
    CHECK(orders.size() > 1);
    CHECK(starts_of(text, 3) == starts_of(text, 3));
  }
}

TEST_CASE("an odd run starts on either side, and all runs on one where there is no other",
          "[protocols][tasks]") {
  std::set<std::ptrdiff_t> below;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto odd = starts_of(with_block(family + grid + "    standard: 4.5\n", 3), seed);
    below.insert(std::ranges::count_if(odd, [](double start) { return start < 4.5; }));
    const auto low = starts_of(with_block(family + grid + "    standard: 3\n"), seed);
    CHECK(std::ranges::all_of(low, [](double start) { return start > 3.0; }));
    const auto high = starts_of(with_block(family + grid + "    standard: 6\n"), seed);
    CHECK(std::ranges::all_of(high, [](double start) { return start < 6.0; }));
  }
  CHECK(below == std::set<std::ptrdiff_t>{1, 2});
}

TEST_CASE("runs over ratios start below and above the geometric middle", "[protocols][tasks]") {
  const auto starts =
      starts_of(with_block(family + "    settings: {from: 3, to: 6, count: 20, spacing: log}\n"
                                    "    reference: one\n"),
                3);
  CHECK(std::ranges::count_if(starts, [](double start) { return start * start < 18.0; }) == 6);
}

TEST_CASE("what cannot be adjusted is refused once, at its line", "[protocols][tasks]") {
  const auto [keys, key, said] = GENERATE(table<std::string, std::string, std::string>({
      {family, "settings", "is missing"},
      {family + "    settings: {from: 3, to: 6, count: 1}\n", "settings.count", "from 2 to 100"},
      {family + "    settings: {from: 3, to: 6, count: 101}\n", "settings.count", "from 2 to 100"},
      {family + "    settings: {from: 6, to: 3, count: 5}\n", "settings.from", "is not below to"},
      {family + "    settings: {from: 3, to: 3, count: 5}\n", "settings.from", "is not below to"},
      {family + "    settings: {from: -1, to: 3, count: 5, spacing: log}\n", "settings.spacing",
       "log needs values above 0"},
      {family + "    settings: {from: 1, to: 6, count: 5}\n", "settings", "1 is not allowed"},
      {family + "    settings: {from: 4, to: 6, count: 5}\n", "settings",
       "do not include it: the standard, 3,"},
      {family + "    settings: {from: 4, to: 6, count: 5}\n    standard: 3.5\n", "standard",
       "is not within the settings, 4 to 6"},
      {family + grid + "    standard: 7\n", "standard", "7 is not allowed"},
      {family + grid + "    axis: thickness_m\n", "axis", "is not a known axis"},
      {family + grid + "    reference: one\n    standard: 4\n", "standard", "not with a reference"},
      {family + grid + "    reference: nothing\n", "reference", "is not a known stimulus"},
      {family + grid + "    reference: family\n", "reference", "is the stimulus that is adjusted"},
      {"    stimuli: [one]\n" + grid, "stimuli", "which must have `vary`"},
      {"    stimuli: [one]\n" + grid + "    axis: thickness_m\n    standard: 4\n", "stimuli",
       "which must have `vary`"},
      {"    stimuli: [family, one]\n" + grid, "stimuli", "an adjustment moves one stimulus"},
      {family + grid + "    correction: true\n", "correction", "not of a setting"},
      {family + grid + "    order: listed\n", "order", "takes no order"},
      {family + grid + "    presented: real\n", "presented", "several alternatives"},
      {family + grid + "    alternatives: 2\n", "alternatives", "is not a known key"},
  }));
  CAPTURE(keys);
  try {
    protocols::parse_protocol(with_block(keys), "study.yaml");
    FAIL("is taken");
  } catch (const core::InvalidInput& error) {
    const std::string what = error.what();
    CAPTURE(what);
    CHECK_THAT(what, Contains("blocks[0]." + key + ":") && Contains(said));
    CHECK(std::ranges::count(what, '\n') <= 1);
    CHECK(what.find("study.yaml:") == what.rfind("study.yaml:"));
  }
}

TEST_CASE("an axis that the technique does not use is refused once", "[protocols][tasks]") {
  std::string text = with_block(family + "    settings: {from: 1e9, to: 3e9, count: 5}\n");
  text = testing::replaced(text, "{sinusoid_amplitude_n_s_per_m: {from: 3, to: 6}}",
                           "{youngs_modulus_pa: {from: 1e9, to: 3e9}}");
  try {
    protocols::parse_protocol(text, "study.yaml");
    FAIL("is taken");
  } catch (const core::InvalidInput& error) {
    const std::string what = error.what();
    CAPTURE(what);
    CHECK_THAT(what, Contains("vary.youngs_modulus_pa"));
    CHECK(what.find("study.yaml:") == what.rfind("study.yaml:"));
  }
}
