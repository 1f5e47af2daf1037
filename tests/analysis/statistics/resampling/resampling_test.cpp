#include <fmt/format.h>

#include <cmath>
#include <map>
#include <stdexcept>

#include "analysis/report/confusion/chance_tests.hpp"
#include "analysis/report/confusion/confusion_summary.hpp"
#include "analysis/statistics/contingency/agreement.hpp"
#include "analysis/statistics/contingency/information_transfer.hpp"
#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/numerics.hpp"
#include "analysis/statistics/resampling/null_tables.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "protocols/schedule/schedule.hpp"
#include "runner/studies/study_summary.hpp"
#include "support/catch.hpp"
#include "support/confusion_tables.hpp"
#include "support/reference_programs.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using namespace tapstudy::testing;

TEST_CASE("replicates do not depend on how many threads compute them",
          "[analysis][resampling][threads]") {
  const Replicate draw = [](std::uint64_t seed) { return core::Rng{seed}.uniform(); };
  const auto alone = replicates(101, draw, 7, 1);
  CHECK(replicates(101, draw, 7, 2) == alone);
  CHECK(replicates(101, draw, 7, 5) == alone);
  CHECK(replicates(101, draw, 7) == alone);
  CHECK(replicates(101, draw, 8) != alone);
  CHECK(replicates(3, draw, 7, 16).size() == 3);
  CHECK(replicates(0, draw, 7).empty());
  CHECK_THROWS_AS(replicates(-1, draw, 7), core::InvalidInput);
  CHECK_THROWS_AS(replicates(
                      8, [](std::uint64_t) -> double { throw std::runtime_error{"failed"}; }, 1, 2),
                  std::runtime_error);
}

TEST_CASE("a random table has the totals of its pattern", "[analysis][resampling]") {
  core::Rng rng{3};
  for (const CountTable& table : all_tables()) {
    const TableTotals totals = totals_of(table);
    for (int draw = 0; draw < 50; ++draw) {
      const TableTotals drawn = totals_of(random_table(totals, rng));
      CHECK(drawn.rows == totals.rows);
      CHECK(drawn.columns == totals.columns);
      CHECK(totals_of(sum_of_random_tables({totals, totals, totals}, rng)).all == 3 * totals.all);
    }
  }
}

TEST_CASE("cells of random tables are drawn as R's hypergeometric distribution says",
          "[analysis][resampling]") {
  constexpr int draws = 20'000;
  for (const auto& [marked, drawn, population] : {std::tuple{20, 20, 80},
                                                  {3, 4, 7},
                                                  {500, 300, 2400},
                                                  {9, 8, 10},
                                                  {40'000, 20'000, 80'000},
                                                  {1'500, 70'000, 80'000},
                                                  {50'000, 3'000, 80'000}}) {
    core::Rng rng{5};
    std::map<std::int64_t, int> seen;
    for (int i = 0; i < draws; ++i) {
      ++seen[random_hypergeometric(marked, drawn, population, rng)];
    }
    double chi_squared = 0.0;
    int cells = 0;
    const auto r =
        r_numbers(fmt::format("p <- dhyper(0:{}, {}, {}, {}); out(ifelse(p < 1e-300, 0, p))", drawn,
                              marked, population - marked, drawn));
    for (std::size_t k = 0; k < r.size(); ++k) {
      const double expected = r[k] * draws;
      const int observed = seen[static_cast<std::int64_t>(k)];
      if (expected < 5.0) {
        CHECK(observed <= 25);
        continue;
      }
      chi_squared += (observed - expected) * (observed - expected) / expected;
      ++cells;
    }
    CHECK(chi_squared_p(chi_squared, cells) > 1e-4);
  }
}

TEST_CASE("the logarithm of a factorial is R's", "[analysis][resampling]") {
  const auto r = r_numbers("out(lfactorial(c(0, 1, 5, 1023, 1024, 1025, 1e6)))");
  std::size_t at = 0;
  for (const std::int64_t n : {0, 1, 5, 1023, 1024, 1025, 1'000'000}) {
    CHECK(log_factorial(n) == Approx(r[at]).epsilon(1e-13));
    ++at;
  }
}

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
      static_cast<const analysis::IdentificationSummary&>(*summary).hypotheses.at(0);
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
