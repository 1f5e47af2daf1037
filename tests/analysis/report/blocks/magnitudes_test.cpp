#include <fmt/format.h>

#include <cmath>
#include <random>

#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/formats.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using testing::r_numbers;
using testing::reported;

namespace {
constexpr const char* statistic = "magnitudes";
const std::vector<double> moduli{1e9, 3e9, 9e9, 27e9};

BlockDesign design_of() {
  BlockDesign design;
  design.name = "stiffness";
  design.axis = VariedAxis{{"youngs_modulus_pa", "Young's modulus", "Pa"}, 1e9, true, false};
  return design;
}

results::AnswerRow answer_of(const std::string& participant, double modulus, double estimate) {
  results::AnswerRow answer;
  answer.participant_id = participant;
  answer.stimulus = "plate";
  answer.response = fmt::format("{}", estimate);
  answer.alternatives = {{0, "", "plate", {{"youngs_modulus_pa", modulus}}, true}};
  return answer;
}

// estimate = modulus of the participant times value^exponent, with errors of 10 %, twice each
std::vector<results::AnswerRow> estimates(double exponent, std::uint64_t seed) {
  std::mt19937_64 generator{seed};
  std::normal_distribution<double> error{0.0, 0.1};
  std::vector<results::AnswerRow> answers;
  for (int person = 0; person < 8; ++person) {
    for (int repetition = 0; repetition < 2; ++repetition) {
      for (const double value : moduli) {
        answers.push_back(
            answer_of(fmt::format("p{}", person), value,
                      (person + 1) * std::pow(value / 1e9, exponent) * std::exp(error(generator))));
      }
    }
  }
  return answers;
}
}  // namespace

TEST_CASE("a report's exponent is R's, and its interval that of R's t test",
          "[analysis][magnitudes]") {
  const auto answers = estimates(0.6, 4);
  std::string people = "list(";
  for (int person = 0; person < 8; ++person) {
    std::string of;
    for (std::size_t i = 0; i < 8; ++i) {
      of += (i == 0 ? "" : ",") + answers[static_cast<std::size_t>(person) * 8 + i].response;
    }
    people += (person == 0 ? "c(" : ",c(") + of + ")";
  }
  const auto r = r_numbers("y <- " + people + "); x <- log10(" + testing::r_vector(moduli) +
                           "); e <- sapply(y, function(v) coef(lm((log10(v[1:4]) + log10(v[5:8]))"
                           " / 2 ~ x))[2]); out(mean(e), t.test(e)$conf.int);"
                           "out(10^mean(sapply(y, function(v) mean(log10(v[c(1, 5)])))))");
  const auto json = reported(statistic, design_of(), answers).json;
  CHECK(json["power_law"][0]["exponent"].get<double>() == Approx(r[0]).epsilon(1e-9));
  CHECK(json["power_law"][0]["exponent_low"].get<double>() == Approx(r[1]).epsilon(1e-9));
  CHECK(json["power_law"][0]["exponent_high"].get<double>() == Approx(r[2]).epsilon(1e-9));
  CHECK(json["means"][0]["geometric_mean"].get<double>() == Approx(r[3]).epsilon(1e-9));
  CHECK(json["power_law"][0]["exponent"].get<double>() == Approx(0.6).epsilon(0.05));
  CHECK(json["participants"].size() == 8);
  CHECK(json["means"][3]["estimates"] == 16);
}

TEST_CASE("estimates on a power law give its exponent in every format", "[analysis][magnitudes]") {
  std::vector<results::AnswerRow> answers;
  for (const char* name : {"a", "b"}) {
    for (const double value : moduli) {
      answers.push_back(answer_of(name, value, std::sqrt(value)));
    }
  }
  const auto formats = reported(statistic, design_of(), answers);
  CHECK(formats.json["power_law"][0]["exponent"].get<double>() == Approx(0.5).epsilon(1e-9));
  CHECK(formats.json["power_law"][0]["r_squared"].get<double>() == Approx(1.0).epsilon(1e-9));
  CHECK_THAT(formats.text, Contains("0.5 (0.5 to 0.5)"));
  CHECK_THAT(formats.html, Contains("0.5 (0.5 to 0.5)"));
  CHECK_THAT(formats.html, Contains("aria-label=\"Magnitude of plate"));
  CHECK(testing::longest_line(formats.text) <= 100);
}

TEST_CASE("where no exponent can be had the report says why and gives the means",
          "[analysis][magnitudes]") {
  auto answers = estimates(0.6, 4);
  answers.push_back(answer_of("p0", 81e9, 100.0));  // a value that the others did not judge
  auto formats = reported(statistic, design_of(), answers);
  CHECK(formats.json["power_law"][0]["exponent"].is_null());
  CHECK_THAT(formats.text, Contains("plate has no exponent: "));
  CHECK(formats.json["means"].size() == 5);
  BlockDesign without_axis = design_of();
  without_axis.axis.reset();
  formats = reported(statistic, without_axis, estimates(0.6, 4));
  CHECK(formats.json["power_law"].empty());
  CHECK_THAT(formats.text, Contains("the stimuli have no values on an axis"));
  CHECK(formats.json["means"].size() == 1);
  CHECK(formats.json["means"][0]["value"].is_null());
  CHECK_THAT(reported(statistic, design_of(), {}).text, Contains("There are no answers"));
}

TEST_CASE("who did not judge all values is left out of the exponent, by name",
          "[analysis][magnitudes]") {
  auto answers = estimates(0.6, 4);
  const std::size_t lacks = answers.size();
  std::erase_if(answers, [](const results::AnswerRow& answer) {
    return answer.participant_id == "p7" &&
           answer.alternatives[0].axis_values.at("youngs_modulus_pa") == moduli.back();
  });
  REQUIRE(answers.size() == lacks - 2);
  const auto formats = reported(statistic, design_of(), answers);
  CHECK_THAT(formats.text, Contains("leave out who did not judge all values: p7"));
  std::erase_if(answers, [](const auto& answer) { return answer.participant_id == "p7"; });
  CHECK(formats.json["power_law"] == reported(statistic, design_of(), answers).json["power_law"]);
}

TEST_CASE("a modulus beside what is judged changes nothing but what is judged",
          "[analysis][magnitudes]") {
  auto answers = estimates(0.6, 4);
  const auto alone = reported(statistic, design_of(), answers).json;
  for (results::AnswerRow& answer : answers) {
    answer.alternatives.insert(answer.alternatives.begin(), {0, "A", "modulus"});
    answer.alternatives.back().position = 1;
    answer.stimulus.clear();
  }
  CHECK(reported(statistic, design_of(), answers).json == alone);
}

TEST_CASE("a magnitude is a number above 0", "[analysis][magnitudes]") {
  for (const std::string response : {"0", "-1", "inf", "nan", "", "3 apples"}) {
    auto answer = answer_of("a", 1e9, 1.0);
    answer.response = response;
    CHECK_THROWS_AS(reported(statistic, design_of(), {answer}), core::InvalidInput);
  }
}
