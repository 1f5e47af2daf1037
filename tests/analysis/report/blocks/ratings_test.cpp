#include "analysis/report/document/wording.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/formats.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using testing::r_numbers;
using testing::reported;

namespace {
constexpr const char* statistic = "ratings";
const std::vector<std::string> names{"steel", "wood", "rubber"};
// Of each participant: the ratings of each stimulus, twice.
const std::vector<std::vector<std::vector<int>>> ratings{
    {{6, 7}, {4, 4}, {1, 2}}, {{5, 5}, {5, 4}, {3, 3}}, {{7, 6}, {3, 4}, {2, 4}},
    {{4, 6}, {6, 6}, {1, 1}}, {{7, 7}, {5, 5}, {3, 2}}, {{5, 6}, {2, 3}, {4, 4}}};

BlockDesign design_of(int steps = 7) {
  BlockDesign design;
  design.name = "hardness";
  design.steps = steps;
  for (const std::string& name : names) {
    design.stimuli.push_back({name, name, {}});
  }
  return design;
}

results::AnswerRow answer_of(const std::string& participant, const std::string& stimulus,
                             const std::string& response) {
  results::AnswerRow answer;
  answer.participant_id = participant;
  answer.stimulus = stimulus;
  answer.response = response;
  return answer;
}

std::vector<results::AnswerRow> all_answers() {
  std::vector<results::AnswerRow> answers;
  for (std::size_t person = 0; person < ratings.size(); ++person) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      for (const int rating : ratings[person][i]) {
        answers.push_back(
            answer_of("p" + std::to_string(person), names[i], std::to_string(rating)));
      }
    }
  }
  return answers;
}

// Medians of two ratings, participants in rows.
std::string r_medians() {
  std::vector<double> medians;
  for (const auto& of_person : ratings) {
    for (const auto& of_stimulus : of_person) {
      medians.push_back(0.5 * (of_stimulus[0] + of_stimulus[1]));
    }
  }
  return "m <- matrix(" + testing::r_vector(medians) + ", ncol = 3, byrow = TRUE);";
}
}  // namespace

TEST_CASE("ratings are tested as R tests the participants' medians", "[analysis][rated]") {
  const auto json = reported(statistic, design_of(), all_answers()).json;
  const auto r =
      r_numbers(testing::exact_signed_rank_p + r_medians() +
                "f <- friedman.test(m); out(f$statistic, f$p.value, "
                "f$statistic / (6 * 2));"
                "p <- sapply(list(c(1, 2), c(1, 3), c(2, 3)), function(k) "
                "exact_signed_rank_p(m[, k[1]] - m[, k[2]])); out(p, p.adjust(p, 'holm'))");
  const auto& friedman = json["friedman"][0];
  CHECK(friedman["chi_squared"].get<double>() == Approx(r[0]).epsilon(1e-9));
  CHECK(friedman["p"].get<double>() == Approx(r[1]).margin(0.05));  // by chi-squared
  CHECK(friedman["kendalls_w"].get<double>() == Approx(r[2]).epsilon(1e-9));
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(json["pairs"][i]["p"].get<double>() == Approx(r[3 + i]).epsilon(1e-9));
    CHECK(json["pairs"][i]["p_holm"].get<double>() == Approx(r[6 + i]).epsilon(1e-9));
  }
}

TEST_CASE("ratings are described by R's quartiles and their counts", "[analysis][rated]") {
  const auto json = reported(statistic, design_of(), all_answers()).json;
  const auto r = r_numbers("out(quantile(c(6,7,5,5,7,6,4,6,7,7,5,6), c(.5, .25, .75)))");
  const auto& steel = json["stimuli"][0];
  CHECK(steel["median"].get<double>() == Approx(r[0]).epsilon(1e-9));
  CHECK(steel["quartile_low"].get<double>() == Approx(r[1]).epsilon(1e-9));
  CHECK(steel["quartile_high"].get<double>() == Approx(r[2]).epsilon(1e-9));
  CHECK(steel["rated_5"] == 3);
  CHECK(steel["rated_7"] == 4);
  CHECK(steel["rated_1"] == 0);
}

TEST_CASE("a claim to be rated highest is tested against the stimulus that contests it most",
          "[analysis][rated]") {
  BlockDesign design = design_of();
  design.hypotheses = {{"h", "Steel feels hardest.", "steel"}};
  const auto formats = reported(statistic, design, all_answers());
  const auto& result = formats.json["hypotheses"][0];
  // medians of steel are above those of wood in five of six, of rubber in all six
  const auto r = r_numbers("out(binom.test(5, 6, 0.5, 'greater')$p.value)");
  CHECK(result["p"].get<double>() == Approx(r[0]).epsilon(1e-9));
  CHECK(result["observed"]["successes"] == 5);
  CHECK_THAT(result["test"].get<std::string>(), Contains("of wood"));
  CHECK(testing::longest_line(formats.text) <= 100);
  design.hypotheses = {{"h", "Gold feels hardest.", "gold"}};
  CHECK_THROWS_AS(reported(statistic, design, all_answers()), core::InvalidInput);
}

TEST_CASE("who did not rate every stimulus is left out of tests and named", "[analysis][rated]") {
  auto answers = all_answers();
  const auto whole = reported(statistic, design_of(), answers).json;
  answers.push_back(answer_of("incomplete", "steel", "1"));
  const auto formats = reported(statistic, design_of(), answers);
  CHECK(formats.json["friedman"] == whole["friedman"]);
  CHECK(formats.json["stimuli"][0]["rated_1"] == 1);
  CHECK_THAT(formats.text, Contains("without ratings of every stimulus: incomplete"));
}

TEST_CASE("what all rate alike is a result as any other, without an interval",
          "[analysis][rated]") {
  std::vector<results::AnswerRow> answers = all_answers();
  for (results::AnswerRow& answer : answers) {
    answer.response = answer.stimulus == "steel" ? "7" : answer.response;
  }
  const auto summary = find_statistic(statistic).summarise(design_of(), {answers, {}});
  REQUIRE(summary->main_results.size() == names.size());
  CHECK(in_words(summary->main_results[0], 6) ==
        "mean of participants' median ratings: steel 7 for all, of 6 participants");
  CHECK(summary->main_results[1].range);
}

TEST_CASE("ratings that cannot be tested say why", "[analysis][rated]") {
  std::vector<results::AnswerRow> answers;
  for (const std::string& name : names) {
    answers.push_back(answer_of("a", name, "3"));
  }
  CHECK_THAT(reported(statistic, design_of(), answers).text, Contains("Not tested: "));
  BlockDesign premised = design_of();
  premised.premise = "it is assumed";
  CHECK(reported(statistic, premised, all_answers()).json["friedman"].empty());
  CHECK_THAT(reported(statistic, design_of(), {}).text, Contains("There are no answers"));
}

TEST_CASE("a rating is a step of the scale", "[analysis][rated]") {
  for (const std::string response : {"0", "8", "3.5", "", "high"}) {
    CHECK_THROWS_AS(reported(statistic, design_of(), {answer_of("a", "steel", response)}),
                    core::InvalidInput);
  }
  CHECK_THROWS_AS(reported(statistic, design_of(), {answer_of("a", "gold", "1")}),
                  core::InvalidInput);
  CHECK_THROWS_AS(reported(statistic, design_of(1), {}), core::InvalidInput);
}

TEST_CASE("marks on a line are tested by R's Friedman test as they are, and have no counts",
          "[analysis][rated]") {
  std::vector<results::AnswerRow> answers = all_answers();
  for (results::AnswerRow& answer : answers) {
    answer.response = std::to_string(0.1 * std::stod(answer.response) + 0.05);
  }
  const auto json = reported(statistic, design_of(0), answers).json;
  const auto r = r_numbers(r_medians() + "t <- friedman.test(m); out(t$statistic)");
  CHECK(json["friedman"][0]["chi_squared"].get<double>() == Approx(r[0]).epsilon(1e-9));
  CHECK_FALSE(json["stimuli"][0].contains("rated_1"));
  answers.front().response = "1.5";
  CHECK_THROWS_WITH(reported(statistic, design_of(0), answers), Contains("a number from 0 to 1"));
}

TEST_CASE("medians of marks that differ by rounding alone are ties", "[analysis][rated]") {
  std::vector<results::AnswerRow> answers;
  for (int person = 0; person < 6; ++person) {
    const std::string name = "p" + std::to_string(person);
    for (const char* const mark : {"0.2", "0.4"}) {  // 0.1 + 0.2 is not 0.3
      answers.push_back(answer_of(name, "steel", mark));
      answers.push_back(answer_of(name, "wood", "0.3"));
      answers.push_back(answer_of(name, "rubber", "0.9"));
    }
  }
  const auto json = reported(statistic, design_of(0), answers).json;
  CHECK(json["pairs"][0]["differing"] == 0);
  CHECK(json["stimuli"][0]["mean_rank"] == 1.5);
}
