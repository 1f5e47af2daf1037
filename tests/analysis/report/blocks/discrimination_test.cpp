#include "analysis/report/blocks/discrimination.hpp"

#include <random>

#include "analysis/statistics/detection/decision_model.hpp"
#include "analysis/statistics/detection/rates.hpp"
#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/population/means.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
#include "support/formats.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using testing::r_numbers;
using testing::reported;

namespace {
constexpr const char* statistic = "discrimination";

BlockDesign design_of(const std::string& model, int alternatives) {
  BlockDesign design;
  design.name = "block";
  design.decision_model = model;
  design.guess_rate = 1.0 / alternatives;
  design.hypotheses = {{"h1", "Participants tell them apart.", ""}};
  return design;
}

results::AnswerRow answer_of(const std::string& participant, bool is_different, bool is_correct) {
  results::AnswerRow answer;
  answer.participant_id = participant;
  answer.is_correct = is_correct;
  answer.alternatives = {{0, "A", "steel"}, {1, "B", is_different ? "wood" : "steel"}};
  return answer;
}

// k right answers in n
void add(std::vector<results::AnswerRow>& answers, const std::string& participant, int k, int n,
         bool is_different = true) {
  for (int i = 0; i < n; ++i) {
    answers.push_back(answer_of(participant, is_different, i < k));
  }
}
}  // namespace

TEST_CASE("each participant, and all of them together, are tested by the exact binomial test",
          "[analysis][discrimination]") {
  std::vector<results::AnswerRow> answers;
  add(answers, "a", 18, 30);
  add(answers, "b", 9, 30);
  add(answers, "c", 22, 30);
  const auto json = reported(statistic, design_of("oddity", 3), answers).json;
  const auto r = r_numbers(
      "out(binom.test(18, 30, 1/3, 'greater')$p.value);"
      "out(binom.test(49, 90, 1/3, 'greater')$p.value)");
  CHECK(json["participants"][0]["p"].get<double>() == Approx(r[0]).epsilon(1e-9));
  CHECK(json["hypotheses"][0]["p"].get<double>() == Approx(r[1]).epsilon(1e-9));
  CHECK(json["all"][0]["p"].get<double>() == Approx(r[1]).epsilon(1e-9));
  CHECK(json["all"][0]["correct"] == 49);
  CHECK(json["all"][0]["correct_of"] == 90);
}

namespace {
enum class Guesser { indifferent, of_habit, reluctant_to_repeat };

// Both places of one comparison in each of so many repetitions, in random order, to people who feel
// no difference.
std::vector<results::AnswerRow> guesses(Guesser guesser, int people, int repetitions,
                                        core::Rng& rng) {
  std::vector<results::AnswerRow> answers;
  for (int person = 0; person < people; ++person) {
    int last = -1;
    for (int trial = 0, first = 0; trial < 2 * repetitions; ++trial) {
      first = trial % 2 == 0 ? static_cast<int>(rng.below(2)) : 1 - first;
      const double habit = guesser == Guesser::of_habit ? 0.8 : 0.5;
      int given = rng.uniform() < habit ? 0 : 1;
      if (guesser == Guesser::reluctant_to_repeat && last >= 0) {
        given = rng.uniform() < 0.25 ? last : 1 - last;
      }
      last = given;
      results::AnswerRow answer = answer_of("p" + std::to_string(person), true, given == first);
      answer.response = given == 0 ? "A" : "B";
      answer.repetition = 1 + trial / 2;
      answers.push_back(answer);
    }
  }
  return answers;
}
}  // namespace

TEST_CASE("where places are balanced guessers are found to discriminate in 3 to 6 % of studies",
          "[analysis][discrimination][slow]") {
  constexpr int studies = 600;
  constexpr double error = 0.009;  // of a share of .05 of them
  const BlockDesign design = design_of("forced_choice", 2);
  for (const Guesser guesser :
       {Guesser::indifferent, Guesser::of_habit, Guesser::reluctant_to_repeat}) {
    core::Rng rng{31};
    int significant = 0;
    for (int study = 0; study < studies; ++study) {
      const auto places = places_redrawn(design, guesses(guesser, 20, 4, rng));
      REQUIRE(places);
      const auto tested =
          permutation_tests(*places, {{{true, false}, {false, true}}}, 199, rng()).front();
      significant += tested.p <= 0.05 ? 1 : 0;
    }
    INFO("guesser " << static_cast<int>(guesser) << ": " << significant << " of " << studies);
    CHECK(significant <= (0.06 + 2.0 * error) * studies);
    CHECK(significant >= (0.03 - 2.0 * error) * studies);
  }
}

TEST_CASE("a report tests discrimination by the places' own randomisation, and says so",
          "[analysis][discrimination]") {
  core::Rng rng{3};
  auto answers = guesses(Guesser::indifferent, 4, 6, rng);
  for (auto& answer : answers) {
    answer.response = *answer.is_correct ? answer.response : answer.response == "A" ? "B" : "A";
    answer.is_correct = true;
  }
  const auto json = reported(statistic, design_of("forced_choice", 2), answers).json;
  CHECK(json["hypotheses"][0]["p"].get<double>() == Approx(1e-4));
  CHECK(json["hypotheses"][0]["p_is_upper_bound"] == true);
  CHECK_THAT(json["hypotheses"][0]["test"].get<std::string>(), Contains("randomisation test"));
  // of one person 2^-6 of the draws are as good
  CHECK(json["participants"][0]["p"].get<double>() == Approx(1.0 / 64.0).margin(0.005));
}

TEST_CASE("what was right is the odd alternative, or the one that X is",
          "[analysis][discrimination]") {
  const auto row = [](const std::string& response, bool is_correct, std::vector<bool> flags,
                      bool has_sample) {
    results::AnswerRow answer;
    answer.participant_id = "p";
    answer.response = response;
    answer.is_correct = is_correct;
    for (std::size_t i = 0; i < flags.size(); ++i) {
      const bool is_sample = has_sample && i + 1 == flags.size();
      answer.alternatives.push_back({static_cast<int>(i),
                                     is_sample ? "X" : std::string(1, static_cast<char>('A' + i)),
                                     flags[i] ? "wood" : "steel",
                                     {},
                                     flags[i]});
    }
    return answer;
  };
  const auto odd =
      places_redrawn(design_of("oddity", 3), {row("A", false, {false, false, true}, false),
                                              row("B", false, {false, true, true}, false),
                                              row("C", true, {true, true, false}, false)});
  REQUIRE(odd);
  // rows: what was right, columns: answers, A to C
  CHECK(odd->observed == CountTable{{0, 1, 0}, {0, 0, 0}, {1, 0, 1}});
  const auto sample =
      places_redrawn(design_of("", 3), {row("A", false, {false, true, false, true}, true),
                                        row("C", true, {false, false, true, true}, true)});
  REQUIRE(sample);
  CHECK(sample->observed == CountTable{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}});
  CHECK_FALSE(places_redrawn(design_of("oddity", 3), {row("A", false, {}, false)}));
}

TEST_CASE("d' is that of the decision model, over participants that of their mean proportion",
          "[analysis][discrimination]") {
  std::vector<results::AnswerRow> answers;
  const std::vector<int> right{18, 25, 22};
  std::vector<Proportion> proportions;
  for (std::size_t i = 0; i < right.size(); ++i) {
    add(answers, std::string(1, static_cast<char>('a' + i)), right[i], 30);
    proportions.push_back({right[i], 30});
  }
  const auto json = reported(statistic, design_of("oddity", 3), answers).json;
  const DecisionTask task{DecisionModel::oddity, 3};
  const Sensitivity first = sensitivity(task, {18, 30});
  CHECK(json["participants"][0]["d_prime"].get<double>() == Approx(first.d_prime).epsilon(1e-9));
  CHECK(json["participants"][0]["d_prime_high"].get<double>() ==
        Approx(first.interval.high).epsilon(1e-9));
  const auto mean = mean_share(proportions);
  const auto& all = json["all"][0];
  CHECK(proportion_correct(task, all["d_prime_of_mean"].get<double>()) ==
        Approx(mean->mean).epsilon(1e-9));
  CHECK(proportion_correct(task, all["d_prime_of_mean_low"].get<double>()) ==
        Approx(std::max(1.0 / 3.0, mean->interval->low)).epsilon(1e-9));  // at chance d' is 0
  CHECK(proportion_correct(task, all["d_prime_of_mean_high"].get<double>()) ==
        Approx(mean->interval->high).epsilon(1e-9));
}

TEST_CASE("where everybody guesses the interval of d' holds 0 as often as it says",
          "[analysis][discrimination]") {
  constexpr int studies = 200;
  core::Rng rng{4};
  int holding = 0;
  for (int study = 0; study < studies; ++study) {
    std::vector<results::AnswerRow> answers;
    for (int person = 0; person < 12; ++person) {
      int right = 0;
      for (int trial = 0; trial < 24; ++trial) {
        right += rng.below(3) == 0 ? 1 : 0;
      }
      add(answers, std::string(1, static_cast<char>('a' + person)), right, 24);
    }
    const auto results = discrimination_results(design_of("oddity", 3), answers);
    holding += results.d_prime_of_mean->interval.low == 0.0 ? 1 : 0;
  }
  CHECK(holding >= 185);  // 97.5 % of them, fewer by chance once in 1000
}

TEST_CASE("where no decision model is known there is no d', and the report says so",
          "[analysis][discrimination]") {
  std::vector<results::AnswerRow> answers;
  add(answers, "a", 18, 30);
  add(answers, "b", 25, 30);
  const auto report = reported(statistic, design_of("", 3), answers);
  CHECK(report.json["participants"][0]["d_prime"].is_null());
  CHECK(report.json["participants"][0]["p"].get<double>() > 0.0);
  CHECK_THAT(report.text, Contains("There is no d'"));
}

TEST_CASE(
    "same-different: hits are right answers to different pairs, false alarms wrong ones to "
    "same pairs",
    "[analysis][discrimination]") {
  std::vector<results::AnswerRow> answers;
  add(answers, "a", 30, 40, true);
  add(answers, "a", 28, 40, false);
  const auto json =
      reported(statistic, design_of("same_different_independent_observation", 2), answers).json;
  CHECK(json["rates"][0]["hits"] == 30);
  CHECK(json["rates"][0]["false_alarms"] == 12);
  CHECK(json["rates"][0]["false_alarms_of"] == 40);
  const double hit_rate = 30.5 / 41.0;
  const double false_alarm_rate = 12.5 / 41.0;
  const auto& row = json["sensitivity_by_rates"][0];
  CHECK(row["d_prime_differencing"].get<double>() ==
        Approx(same_different_differencing(hit_rate, false_alarm_rate).d_prime).epsilon(1e-9));
  CHECK(row["d_prime_independent"].get<double>() ==
        Approx(same_different_independent(hit_rate, false_alarm_rate).d_prime).epsilon(1e-9));
  const auto r = r_numbers("out(-(qnorm(30.5 / 41) + qnorm(12.5 / 41)) / 2)");
  CHECK(row["criterion"].get<double>() == Approx(r[0]).epsilon(1e-9));
}

TEST_CASE("the sensitivity of a simulated differencing observer lies near the one assumed",
          "[analysis][discrimination]") {
  std::mt19937_64 generator{5};
  std::normal_distribution<double> noise;
  std::vector<results::AnswerRow> answers;
  for (int i = 0; i < 20000; ++i) {
    const bool is_different = i % 2 == 0;
    const double difference = noise(generator) - noise(generator) + (is_different ? 2.0 : 0.0);
    answers.push_back(answer_of("a", is_different, is_different == (std::abs(difference) > 1.5)));
  }
  const auto json = reported(statistic, design_of("", 2), answers).json;
  CHECK(json["sensitivity_by_rates"][0]["d_prime_differencing"].get<double>() ==
        Approx(2.0).epsilon(0.05));
  CHECK(json["participants"][0]["d_prime"].is_null());
}

TEST_CASE("alternatives that differ in a value only are different", "[analysis][discrimination]") {
  std::vector<results::AnswerRow> answers;
  add(answers, "a", 5, 8, false);
  answers[0].alternatives[0].axis_values = {{"density_kg_m3", 1.0}};
  answers[0].alternatives[1].axis_values = {{"density_kg_m3", 2.0}};
  const auto json = reported(statistic, design_of("", 2), answers).json;
  CHECK(json["rates"][0]["hits_of"] == 1);
  CHECK(json["rates"][0]["false_alarms_of"] == 7);
}

TEST_CASE("a test that cannot be made says why", "[analysis][discrimination]") {
  std::vector<results::AnswerRow> answers;
  BlockDesign design = design_of("oddity", 3);
  CHECK_THAT(reported(statistic, design, answers).text, Contains("there are no answers"));
  add(answers, "a", 8, 8);
  CHECK(reported(statistic, design, answers).json["hypotheses"][0]["p"].get<double>() ==
        Approx(std::pow(3.0, -8.0)));
  design.premise = "it is assumed";
  const auto formats = reported(statistic, design, answers);
  CHECK_THAT(formats.text, Contains("not tested: it is assumed"));
  CHECK(formats.json["participants"][0]["p"].is_null());
  CHECK_THAT(reported(statistic, design_of("oddity", 3), {}).text,
             Contains("there are no answers"));
}

TEST_CASE("discrimination refuses what it cannot count and says what it assumes",
          "[analysis][discrimination]") {
  std::vector<results::AnswerRow> answers;
  add(answers, "a", 8, 8);
  add(answers, "b", 1, 8);
  CHECK_THROWS_AS(reported(statistic, design_of("unknown", 2), answers), core::InvalidInput);
  CHECK_THROWS_AS(reported(statistic, design_of("abx_differencing", 3), answers),
                  core::InvalidInput);
  const auto formats = reported(statistic, design_of("abx_differencing", 2), answers);
  CHECK_THAT(formats.text, Contains("as independent"));
  CHECK_THAT(formats.html, Contains("a: all correct: d&#39; computed") ||
                               Contains("a: all correct: d' computed"));
  CHECK_THAT(formats.text, Contains("b: below chance: d' is 0 (were answers swapped?)."));
  CHECK(formats.json["participants"][0]["d_prime_high"] == "inf");
  CHECK(testing::longest_line(formats.text) <= 100);
  answers[0].is_correct.reset();
  CHECK_THROWS_AS(reported(statistic, design_of("", 2), answers), core::InvalidInput);
}
