#include <cmath>
#include <random>

#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/formats.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using testing::reported;

namespace {
constexpr const char* statistic = "equality";
constexpr double standard = 2000.0;
const std::vector<double> fractions{-0.4, -0.2, -0.1, 0.0, 0.1, 0.2, 0.4};

BlockDesign design_of(bool is_smaller_asked = false) {
  BlockDesign design;
  design.name = "stiffness";
  design.axis = VariedAxis{
      {"youngs_modulus_pa", "Young's modulus", "Pa"}, standard, true, false, is_smaller_asked};
  design.guess_rate = 0.5;
  design.shape = core::PsychometricShape::cumulative_gaussian;
  return design;
}

results::AnswerRow answer_to(const std::string& participant, double fraction,
                             bool names_comparison) {
  results::AnswerRow answer;
  answer.participant_id = participant;
  answer.response = names_comparison ? "B" : "A";
  answer.alternatives = {
      {0, "A", "plate", {{"youngs_modulus_pa", standard}}, false},
      {1, "B", "plate", {{"youngs_modulus_pa", standard * (1.0 + fraction)}}, true}};
  return answer;
}

// Judges comparisons by a cumulative Gaussian around the point of equality.
std::vector<results::AnswerRow> observer(const std::string& name, double equality, double jnd,
                                         std::uint64_t seed) {
  constexpr int repetitions = 40;
  constexpr double quartile = 0.6744897501960817;
  std::mt19937_64 generator{seed};
  std::normal_distribution<> noise{0.0, jnd / quartile};
  std::vector<results::AnswerRow> answers;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    for (const double fraction : fractions) {
      answers.push_back(answer_to(name, fraction, fraction + noise(generator) > equality));
    }
  }
  return answers;
}
}  // namespace

TEST_CASE("the point of equality and the just noticeable difference of an observer are found",
          "[analysis][equality][slow]") {
  int held_equality = 0;
  int held_jnd = 0;
  constexpr int observers = 100;
  for (std::uint64_t seed = 1; seed <= observers; ++seed) {
    const auto json = reported(statistic, design_of(), observer("p", 0.05, 0.12, seed)).json;
    const auto& row = json["participants"][0];
    REQUIRE(row["constant_error"].is_number());
    CHECK(row["equality"].get<double>() ==
          Approx(standard * (1.0 + row["constant_error"].get<double>())).epsilon(1e-9));
    held_equality += row["constant_error_low"] <= 0.05 && row["constant_error_high"] >= 0.05;
    held_jnd += row["jnd_low"] <= 0.12 && row["jnd_high"] >= 0.12;
  }
  CHECK(held_equality >= 88);  // of 95 expected, four standard errors below
  CHECK(held_jnd >= 86);
}

TEST_CASE("who is asked for the smaller one and names it judges the other one greater",
          "[analysis][equality]") {
  auto answers = observer("p", -0.1, 0.1, 3);
  const auto greater = reported(statistic, design_of(false), answers).json;
  for (results::AnswerRow& answer : answers) {
    answer.response = answer.response == "A" ? "B" : "A";
  }
  CHECK(reported(statistic, design_of(true), answers).json == greater);
  CHECK(greater["levels"][0]["judged_greater"] < greater["levels"][6]["judged_greater"]);
}

TEST_CASE("over participants each point of equality counts once, by R's t and sign flips",
          "[analysis][equality]") {
  std::vector<results::AnswerRow> answers;
  for (const auto& [name, equality, jnd] :
       {std::tuple{"a", 0.10, 0.1}, {"b", 0.02, 0.15}, {"c", -0.03, 0.2}, {"d", 0.15, 0.1}}) {
    const auto more = observer(name, equality, jnd, 11);
    answers.insert(answers.end(), more.begin(), more.end());
  }
  const auto json = reported(statistic, design_of(), answers).json;
  std::vector<double> errors;
  std::vector<double> jnds;
  for (const auto& row : json["participants"]) {
    errors.push_back(row["constant_error"]);
    jnds.push_back(row["jnd"]);
  }
  const auto r = testing::r_numbers(
      "e <- " + testing::r_vector(errors) + "; j <- " + testing::r_vector(jnds) +
      "; s <- as.matrix(expand.grid(rep(list(c(-1, 1)), 4)));"
      "out(mean(e), t.test(e)$conf.int, exp(mean(log(j))), exp(t.test(log(j))$conf.int),"
      "mean(abs(s %*% e) >= abs(sum(e)) - 1e-12))");
  const auto& all = json["over_participants"][0];
  CHECK(all["constant_error"].get<double>() == Approx(r[0]).epsilon(1e-9));
  CHECK(all["constant_error_low"].get<double>() == Approx(r[1]).epsilon(1e-9));
  CHECK(all["constant_error_high"].get<double>() == Approx(r[2]).epsilon(1e-9));
  CHECK(all["jnd"].get<double>() == Approx(r[3]).epsilon(1e-9));
  CHECK(all["jnd_low"].get<double>() == Approx(r[4]).epsilon(1e-9));
  CHECK(all["jnd_high"].get<double>() == Approx(r[5]).epsilon(1e-9));
  CHECK(all["p"].get<double>() == Approx(r[6]).epsilon(1e-12));
}

TEST_CASE("who always judges alike has no point of equality, and the report says so",
          "[analysis][equality]") {
  std::vector<results::AnswerRow> answers;
  for (const double fraction : fractions) {
    answers.push_back(answer_to("p", fraction, true));
  }
  const auto formats = reported(statistic, design_of(), answers);
  CHECK(formats.json["participants"][0]["equality"].is_null());
  CHECK_THAT(formats.text, Contains("p has no point of equality"));
  CHECK(testing::longest_line(formats.text) <= 100);
  answers[0].response = "C";
  CHECK_THROWS_AS(reported(statistic, design_of(), answers), core::InvalidInput);
  BlockDesign without_axis = design_of();
  without_axis.axis.reset();
  CHECK_THROWS_AS(reported(statistic, without_axis, answers), core::InvalidInput);
  CHECK_THAT(reported(statistic, design_of(), {}).text, Contains("There are no answers"));
}
