// Reports of the method of adjustment.
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
constexpr const char* statistic = "adjustments";
constexpr int people = 7;
constexpr int runs = 6;

BlockDesign design_of(bool is_logarithmic, std::optional<double> standard = 3.0) {
  BlockDesign design;
  design.name = "strength";
  design.adjusted = AdjustedAxis{{"sinusoid_amplitude_n_s_per_m", "sinusoid amplitude", "N s/m"},
                                 is_logarithmic,
                                 standard.value_or(3.0),
                                 standard};
  return design;
}

results::AnswerRow answer_of(const std::string& participant, double start, double value) {
  results::AnswerRow answer;
  answer.participant_id = participant;
  answer.response = fmt::format("{}", value);
  answer.first_setting = start;
  return answer;
}

// Runs from above end `lag` higher, as a factor, than runs from below.
std::vector<results::AnswerRow> settings(double lag) {
  std::mt19937_64 generator{3};
  std::normal_distribution<double> error{0.0, 0.2};
  std::vector<results::AnswerRow> answers;
  for (int person = 0; person < people; ++person) {
    const double own = 3.3 * std::exp(error(generator));
    for (int run = 0; run < runs; ++run) {
      const bool is_from_above = run % 2 == 1;
      answers.push_back(answer_of(fmt::format("p{}", person), is_from_above ? 5.0 : 1.0,
                                  own * std::exp(error(generator)) * (is_from_above ? lag : 1.0)));
    }
  }
  return answers;
}

// A matrix of the settings, a row for each participant.
std::string r_matrix(const std::vector<results::AnswerRow>& answers) {
  std::vector<double> values;
  for (const results::AnswerRow& answer : answers) {
    values.push_back(std::stod(answer.response));
  }
  return fmt::format("x <- matrix({}, nrow = {}, byrow = TRUE); ", testing::r_vector(values),
                     people);
}

void check_mean(const nlohmann::ordered_json& row, const std::vector<double>& r, std::size_t at) {
  CHECK(row["mean"].get<double>() == Approx(r.at(at)).epsilon(1e-9));
  CHECK(row["mean_low"].get<double>() == Approx(r.at(at + 1)).epsilon(1e-9));
  CHECK(row["mean_high"].get<double>() == Approx(r.at(at + 2)).epsilon(1e-9));
}
}  // namespace

TEST_CASE("equality, constant error, deviation and lag of settings are R's, with their intervals",
          "[analysis][adjustments]") {
  const bool is_logarithmic = GENERATE(false, true);
  const auto answers = settings(1.4);
  const auto r = r_numbers(
      r_matrix(answers) +
      (is_logarithmic ? "f <- log; g <- exp; " : "f <- identity; g <- identity; ") +
      "y <- f(x); m <- rowMeans(y); s <- apply(y, 1, sd); d <- rowMeans(y[, c(1, 3, 5)]) - "
      "rowMeans(y[, c(2, 4, 6)]); ci <- function(v, g) c(g(mean(v)), g(t.test(v)$conf.int)); "
      // of what is not below 0 the upper end is that of a variance in proportion to the mean
      "up <- function(v) { b <- mean(v); c(b, t.test(v)$conf.int[1], uniroot(function(a) (b - a)^2 "
      "- qt(.975, length(v) - 1)^2 * var(v) / length(v) * a / b, c(b, 1e3), tol = 1e-12)$root) }; "
      "out(" +
      (is_logarithmic ? "ci(m, g)" : "up(m)") +
      ", ci(m - f(3), g), up(s), ci(d, g), g(m[1]), s[1], g(m[1] - f(3)), "
      "g(mean(y[1, c(1, 3, 5)])))");
  const auto json = reported(statistic, design_of(is_logarithmic), answers).json;
  for (std::size_t row = 0; row < 4; ++row) {
    check_mean(json["over_participants"][row], r, 3 * row);
    CHECK(json["over_participants"][row]["participants"] == people);
  }
  const auto& first = json["participants"][0];
  CHECK(first["mean"].get<double>() == Approx(r.at(12)).epsilon(1e-9));
  CHECK(first["standard_deviation"].get<double>() == Approx(r.at(13)).epsilon(1e-9));
  CHECK(first["constant_error"].get<double>() == Approx(r.at(14)).epsilon(1e-9));
  CHECK(first["ascending"].get<double>() == Approx(r.at(15)).epsilon(1e-9));
}

TEST_CASE("p of settings is that of all patterns of signs, by R", "[analysis][adjustments]") {
  const auto answers = settings(1.1);
  const auto r =
      r_numbers(r_matrix(answers) +
                "y <- log(x); p <- function(d) { s <- as.matrix(expand.grid(rep(list(c(-1, 1)), "
                "length(d)))); "
                "mean(abs(s %*% d) >= abs(sum(d)) - 1e-12) }; out(p(rowMeans(y) - log(3)), "
                "p(rowMeans(y[, c(1, 3, 5)]) - rowMeans(y[, c(2, 4, 6)])))");
  const auto json = reported(statistic, design_of(true), answers).json;
  CHECK(json["over_participants"][1]["p"].get<double>() == Approx(r[0]).epsilon(1e-9));
  CHECK(json["over_participants"][3]["p"].get<double>() == Approx(r[1]).epsilon(1e-9));
}

TEST_CASE("without a standard on the axis there is no constant error, and the report says so",
          "[analysis][adjustments]") {
  const auto report = reported(statistic, design_of(true, std::nullopt), settings(1.0));
  CHECK(report.json["over_participants"].size() == 3);
  CHECK(report.json["participants"][0]["constant_error"].is_null());
  CHECK_THAT(report.text, Contains("There is no constant error"));
  CHECK_THAT(report.html, Contains("There is no constant error"));
}

TEST_CASE("one participant's settings are described, nothing is tested",
          "[analysis][adjustments]") {
  const std::vector<results::AnswerRow> one{answer_of("p", 1.0, 4.0)};
  const auto json = reported(statistic, design_of(false), one).json;
  CHECK(json["over_participants"][0]["mean"] == 4.0);
  CHECK(json["over_participants"][0]["mean_low"].is_null());
  CHECK(json["over_participants"][1]["p"].is_null());
  CHECK(json["participants"][0]["standard_deviation"].is_null());
  CHECK(json["participants"][0]["descending"].is_null());
  CHECK_THAT(reported(statistic, design_of(false), {}).text, Contains("There are no answers"));
}

TEST_CASE("what is no setting is refused", "[analysis][adjustments]") {
  for (const char* const text : {"", "A", "4 N", "nan", "inf", "0", "-1"}) {
    CAPTURE(text);
    results::AnswerRow answer = answer_of("p", 1.0, 4.0);
    answer.response = text;
    CHECK_THROWS_WITH(reported(statistic, design_of(true), {answer}),
                      Contains("is not a value of sinusoid_amplitude_n_s_per_m"));
  }
  BlockDesign nothing = design_of(true);
  nothing.adjusted.reset();
  CHECK_THROWS_WITH(reported(statistic, nothing, {}), Contains("no axis is adjusted"));
}
