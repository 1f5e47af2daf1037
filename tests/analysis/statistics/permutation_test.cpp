#include "analysis/statistics/permutation_test.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "analysis/agreement/independence.hpp"
#include "analysis/identification/chance_tests.hpp"
#include "analysis/identification/identification_summary.hpp"
#include "analysis/information/information_transfer.hpp"
#include "core/rng.hpp"
#include "protocols/read_protocol.hpp"
#include "protocols/schedule.hpp"
#include "runner/experiments/study_design.hpp"
#include "support/catch.hpp"
#include "support/r_program.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using analysis::Answers;
using protocols::Order;

namespace {
// Whoever cannot feel anything: answers that depend on the place of the trial alone, as of those
// who use up every answer once a repetition.
std::vector<results::AnswerRow> guesses(const protocols::Protocol& protocol, std::uint64_t study) {
  std::vector<results::AnswerRow> answers;
  core::Rng rng{core::derived_seed(study, core::Purpose::observer)};
  for (int participant = 0; participant < 6; ++participant) {
    const auto index = static_cast<std::uint64_t>(participant);
    const std::uint64_t seed = core::derived_seed(study, core::Purpose::participant, index);
    std::vector<std::string> left;
    for (const protocols::PlannedTrial& trial : make_schedule(protocol, seed, participant)) {
      if (left.empty()) {
        left = protocol.blocks[0].stimuli;
        rng.shuffle(left);
      }
      results::AnswerRow answer;
      answer.participant_id = std::to_string(participant);
      answer.participant_index = participant;
      answer.order_index = participant;
      answer.block = trial.block;
      answer.number = trial.number;
      answer.place_in_block = answer.number - 1;
      answer.stimulus = trial.alternatives.front().stimulus;
      answer.response = left.back();
      answer.is_correct = answer.response == answer.stimulus;
      left.pop_back();
      answers.push_back(answer);
    }
  }
  return answers;
}
}  // namespace

TEST_CASE(
    "of studies in which nobody felt anything, no more than the level are significant by accuracy, "
    "information or dependence, whatever the order",
    "[analysis][slow]") {
  protocols::Protocol protocol =
      protocols::read_protocol(testing::shipped("paper/discrimination.yaml").string());
  protocols::Block& block = protocol.blocks.at(0);
  block.order = GENERATE(Order::shuffle, Order::shuffle_within_repetition, Order::williams);
  constexpr int studies = 400;
  constexpr int draws = 199;
  std::map<std::string, int> significant;
  for (int study = 0; study < studies; ++study) {
    const auto seed = static_cast<std::uint64_t>(study);
    protocol.counterbalancing_seed = seed;
    const auto design = runner::design_of(protocol, results::Mode::real).blocks.at(0);
    const auto randomisation = analysis::randomisation_of(
        design, analysis::identification_data(design, guesses(protocol, seed)));
    const auto& tables = *randomisation.tables;
    const auto tests = analysis::chance_tests(randomisation, {design.stimuli, design.responses}, {},
                                              {draws, seed});
    significant["accuracy"] += tests.accuracy->p <= 0.05 ? 1 : 0;
    significant["information"] +=
        analysis::guessed_information(tables, draws, seed).p <= 0.05 ? 1 : 0;
    significant["dependence"] +=
        analysis::monte_carlo_independence(tables, draws, seed).p <= 0.05 ? 1 : 0;
  }
  const double error = std::sqrt(0.05 * 0.95 * studies);
  for (const auto& [name, times] : significant) {
    fmt::print("  order {}, {}: {} of {} null studies significant at .05\n",
               static_cast<int>(block.order), name, times, studies);
    CHECK(times <= 0.05 * studies + 4.0 * error);
    CHECK(times >= 0.05 * studies - 4.0 * error);
  }
}

TEST_CASE("an order that was not drawn has no test of chance", "[analysis]") {
  protocols::Protocol protocol =
      protocols::read_protocol(testing::shipped("paper/discrimination.yaml").string());
  protocol.blocks.at(0).order = Order::listed;
  const auto design = runner::design_of(protocol, results::Mode::real);
  const auto summary =
      analysis::summarise_identification(design.blocks.at(0), {guesses(protocol, 1), {}});
  const auto& hypothesis =
      dynamic_cast<const analysis::IdentificationSummary&>(*summary).hypotheses.at(0);
  CHECK_FALSE(hypothesis.p);
  CHECK(hypothesis.test.find("listed") != std::string::npos);
}

TEST_CASE("answers shuffled within participants have the p of coin's exact stratified test",
          "[analysis]") {
  const std::vector<std::vector<analysis::CountTable>> studies{
      {{{6, 2}, {3, 5}}, {{4, 4}, {2, 6}}, {{7, 1}, {3, 5}}},
      {{{3, 5}, {4, 4}}, {{5, 3}, {4, 4}}},
      {{{5, 1}, {0, 4}}, {{6, 0}, {4, 2}}}};
  for (const auto& participants : studies) {
    std::vector<std::int64_t> cells;
    for (const auto& table : participants) {
      for (const auto& row : table) {
        cells.insert(cells.end(), row.begin(), row.end());
      }
    }
    const double coin = testing::r_numbers("suppressPackageStartupMessages(library(coin)); n <- " +
                                           testing::r_vector(cells) + R"(
d <- expand.grid(response = 0:1, stimulus = gl(2, 1), person = gl(length(n) / 4, 1))
d <- d[rep(seq_along(n), n), ]
out(pvalue(independence_test(response ~ stimulus | person, d, distribution = exact(),
                             alternative = 'less'))))")
                            .front();
    constexpr int draws = 20'000;
    const auto ours = analysis::permutation_tests(analysis::shuffled_tables(participants),
                                                  {{{true, false}, {false, true}}}, draws, 1);
    CHECK(ours.front().p == Approx(coin).margin(5.0 * std::sqrt(coin * (1.0 - coin) / draws)));
  }
}

TEST_CASE("someone who always gives one answer is not better than chance", "[analysis]") {
  const Answers stubborn{{0, 1, 0, 1}, {0, 0, 0, 0}};
  const auto tables = analysis::redrawn_tables(
      {stubborn},
      [](std::size_t /*person*/, std::uint64_t draw) {
        return draw % 2 == 0 ? std::vector<int>{0, 1, 0, 1} : std::vector<int>{1, 0, 1, 0};
      },
      2, 2);
  const auto result =
      analysis::permutation_tests(tables, {{{true, false}, {false, true}}}, 99, 1).front();
  CHECK(result.p == 1.0);
  CHECK(result.as_good == 99);
}
