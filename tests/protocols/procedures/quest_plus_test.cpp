// QUEST+ against python3-questplus (Debian), by answers to stimuli drawn at random.
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/rng.hpp"
#include "protocols/procedures/posterior.hpp"
#include "protocols/procedures/quest_plus_track.hpp"
#include "support/catch.hpp"
#include "support/procedures.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using json = nlohmann::ordered_json;  // the order of parameters is that of the posterior
using protocols::LikelihoodTable;
using protocols::QuestPlusTrack;

namespace {
constexpr int sequences_of_each = 150;
constexpr double precision = 1e-12;
const std::string folder = "tests/protocols/procedures/";

using Table = std::shared_ptr<const LikelihoodTable>;

json random_sequences(const LikelihoodTable& table, core::Rng& rng) {
  json all = json::array();
  for (int i = 0; i < sequences_of_each; ++i) {
    json sequence = json::array();
    for (std::uint32_t left = 1 + rng.below(24); left > 0; --left) {
      const auto stimulus = rng.below(static_cast<std::uint32_t>(table.stimuli()));
      const auto outcome = rng.below(static_cast<std::uint32_t>(table.design().outcomes));
      sequence.push_back(json::array({table.stimulus(stimulus), outcome}));
    }
    all.push_back(sequence);
  }
  return all;
}

Table table_of(const json& one) {
  json procedure = one["ours"];
  procedure["stop"]["trials"] = 100;
  const json whole{{"quest_plus", procedure}};
  const auto settings = testing::procedure_of(whole.dump());
  return std::make_shared<const LikelihoodTable>(
      dynamic_cast<const protocols::QuestPlusSettings&>(*settings).table());
}

// Answers below a border at `low`, above it, or above a second one, `distance` higher.
Table ordered_categories() {
  protocols::QuestPlusDesign design;
  design.axes = {{-3, -2, -1, 0, 1, 2, 3}};
  design.parameters = {{"low", {-2, -1, 0, 1}, {1, 1, 1, 1}}, {"distance", {0.5, 1, 2}, {1, 1, 1}}};
  design.outcomes = 3;
  design.model = [](auto stimulus, auto parameters, auto probabilities) {
    const auto above = [&](double border) { return 1.0 / (1.0 + std::exp(border - stimulus[0])); };
    const double one = above(parameters[0]);
    const double two = above(parameters[0] + parameters[1]);
    probabilities[0] = 1.0 - one;
    probabilities[1] = one - two;
    probabilities[2] = two;
  };
  return std::make_shared<const LikelihoodTable>(design);
}

void check_estimates(const LikelihoodTable& table, const QuestPlusTrack& track,
                     const json& theirs) {
  const auto ours = track.summary().parameters;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    INFO(ours[i].name);
    CHECK(ours[i].mean == Approx(theirs[i]["mean"].get<double>()).margin(precision));
    CHECK(ours[i].mode == theirs[i]["mode"].get<double>());
    CHECK(ours[i].standard_deviation == Approx(theirs[i]["sd"].get<double>()).margin(1e-8));
    const auto& values = table.design().parameters[i].values;
    for (const auto& [probability, value] : ours[i].quantiles) {
      double below = 0.0;
      std::size_t place = 0;
      for (; values[place] < value; ++place) {
        below += theirs[i]["marginal"][place].get<double>();
      }
      CHECK(below <= probability);
      CHECK(below + theirs[i]["marginal"][place].get<double>() >= probability - precision);
    }
  }
}

void check_same(const Table& table, const json& sequence, const json& theirs) {
  QuestPlusTrack track{table, {100, {}}};
  for (const json& trial : sequence) {
    track.observe(trial[0].get<std::vector<double>>(), trial[1].get<std::size_t>());
  }
  const auto expected = theirs["posterior"].get<std::vector<double>>();
  REQUIRE(track.posterior().size() == expected.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    worst = std::max(worst, std::abs(track.posterior()[i] - expected[i]));
  }
  CHECK(worst < precision);
  if (!theirs["estimates"].empty()) {
    check_estimates(*table, track, theirs["estimates"]);
  }
  const auto entropies = protocols::expected_entropies(*table, track.posterior());
  const double least = *std::ranges::min_element(entropies);
  CHECK(least == Approx(theirs["entropy"].get<double>()).margin(precision));
  const auto chosen = theirs["next"].get<std::vector<double>>();
  if (track.next() != chosen) {
    // then both are as good: rounding, which we disregard, decided theirs
    for (std::size_t i = 0; i < entropies.size(); ++i) {
      const bool is_either = table->stimulus(i) == chosen || table->stimulus(i) == *track.next();
      CHECK((!is_either || entropies[i] <= least + protocols::entropy_tie));
    }
  }
}
}  // namespace

TEST_CASE("posterior and next stimulus of QUEST+ are those of questplus",
          "[protocols][procedures][slow]") {
  json cases = json::parse(testing::contents(testing::source(folder + "questplus_cases.json")));
  std::vector<Table> tables;
  std::ranges::transform(cases, std::back_inserter(tables), table_of);
  cases.push_back(json::parse(
      R"({"name": "three outcomes", "categories": true, "estimates": true, "questplus": {
    "func": "weibull", "stim_scale": "log10", 
    "stim_domain": {"intensity": [-3, -2, -1, 0, 1, 2, 3]},
    "param_domain": {"threshold": [-2, -1, 0, 1], "slope": [0.5, 1, 2]}}})"));
  tables.push_back(ordered_categories());
  core::Rng rng{7};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    cases[i]["sequences"] = random_sequences(*tables[i], rng);
  }
  const auto run = testing::run_program(
      {"/usr/bin/python3", testing::source(folder + "questplus_answers.py")}, cases.dump());
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  const json theirs = json::parse(run.standard_output);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (std::size_t j = 0; j < sequences_of_each; ++j) {
      INFO(cases[i]["name"] << ", sequence " << j << ": " << cases[i]["sequences"][j]);
      check_same(tables[i], cases[i]["sequences"][j], theirs[i][j]);
    }
  }
}
