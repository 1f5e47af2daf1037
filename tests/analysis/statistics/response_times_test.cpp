#include "analysis/statistics/response_times.hpp"

#include <array>

#include "analysis/statistics/population/serial_dependence.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using testing::r_numbers;

TEST_CASE("balanced integration scores are R's standardised shares less standardised times",
          "[analysis][response_times]") {
  const auto scores =
      balanced_integration_scores({{0.5, 1.2}, {0.75, 2.0}, {0.9, 1.4}, {0.25, 0.8}});
  const auto r = r_numbers(
      "z <- function(x) (x - mean(x)) / sqrt(mean((x - mean(x))^2));"
      "out(z(c(.5, .75, .9, .25)) - z(c(1.2, 2, 1.4, .8)))");
  for (std::size_t i = 0; i < scores.size(); ++i) {
    CHECK(scores[i] == Approx(r[i]).epsilon(1e-9));
  }
  CHECK(balanced_integration_scores({{0.5, 1.0}}).empty());
  CHECK(balanced_integration_scores({{0.5, 1.0}, {0.5, 1.0}}) == std::vector<double>{0.0, 0.0});
}

TEST_CASE("conditional accuracy averages equal parts of each participant's ordered answers",
          "[analysis][response_times]") {
  const auto bins = conditional_accuracy(
      {{{4, true}, {1, false}, {2, true}, {3, true}}, {{10, false}, {20, true}}, {{1, true}}}, 2);
  REQUIRE(bins.size() == 2);
  CHECK(bins[0].mean_time_s == Approx(0.5 * (1.5 + 10)).epsilon(1e-9));
  CHECK(bins[0].share_right == Approx(0.5 * (0.5 + 0.0)).epsilon(1e-9));
  CHECK(bins[1].mean_time_s == Approx(0.5 * (3.5 + 20)).epsilon(1e-9));
  CHECK(bins[1].share_right == Approx(1.0).epsilon(1e-9));
  CHECK(conditional_accuracy({{{1, true}}}, 2).empty());
  CHECK_THROWS_AS(conditional_accuracy({}, 0), core::InvalidInput);
}

TEST_CASE("who repeats the last answer is found, and what is confused with what is not",
          "[analysis][participants]") {
  AnswerSequence repeating;
  AnswerSequence confusing;
  for (std::size_t i = 0; i < 40; ++i) {
    const std::size_t stimulus = (i * 7 + i / 3) % 4;
    const std::size_t last = i == 0 ? 0 : repeating.responses.back();
    for (AnswerSequence* of : {&repeating, &confusing}) {
      of->stimuli.push_back(stimulus);
      of->right.push_back(stimulus);
    }
    repeating.responses.push_back(i % 4 == 0 ? (last + 1) % 4 : last);
    confusing.responses.push_back((stimulus + 1) % 4);
  }
  const SerialDependence found = serial_dependence({repeating}, 999, 1);
  CHECK(found.repeated_answer.p == Approx(0.001).epsilon(1e-9));
  CHECK(found.repeated_answer.observed > found.repeated_answer.expected);
  const SerialDependence none = serial_dependence({confusing}, 999, 1);
  CHECK(none.repeated_answer.p == 1.0);
  CHECK(none.last_right.p == 1.0);
  CHECK(serial_dependence({repeating}, 200, 5, 1).last_right.p ==
        serial_dependence({repeating}, 200, 5, 3).last_right.p);
  CHECK(serial_dependence({}, 9, 1).repeated_answer.p == 1.0);
  CHECK_THROWS_AS(serial_dependence({{{1}, {1}, {}}}, 9, 1), core::InvalidInput);
  CHECK_THROWS_AS(serial_dependence({confusing}, 0, 1), core::InvalidInput);
}

// p by the spread of few draws is that by counting many.
TEST_CASE("of very many trials few permutations say how improbable an effect is",
          "[analysis][response_times]") {
  core::Rng rng{3};
  AnswerSequence sequence;
  for (std::size_t i = 0; i < 3000; ++i) {
    const std::size_t stimulus = rng.below(4);
    const bool repeats = i > 0 && rng.uniform() < 0.025;
    sequence.stimuli.push_back(stimulus);
    sequence.right.push_back(stimulus);
    sequence.responses.push_back(repeats ? sequence.responses.back() : rng.below(4));
  }
  const double by_counting = serial_dependence({sequence}, 9999, 1).repeated_answer.p;
  REQUIRE(by_counting > 0.001);
  REQUIRE(by_counting < 0.2);
  double mean_log = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    mean_log += std::log(serial_dependence({sequence}, 99, seed).repeated_answer.p) / 20.0;
  }
  CHECK(mean_log == Approx(std::log(by_counting)).margin(0.3));
}

TEST_CASE("what is expected of a trial after another is the mean over all permutations",
          "[analysis][response_times]") {
  // one stimulus answered 0 0 1, the other 1 2; permuted 3 x 2 ways
  const AnswerSequence observed{{0, 1, 0, 0, 1}, {0, 1, 0, 0, 1}, {0, 1, 0, 1, 2}};
  double repeated = 0.0;
  double last_right = 0.0;
  for (const auto& first : {std::array{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}) {
    for (const auto& second : {std::array{1, 2}, {2, 1}}) {
      const std::array<int, 5> given{first[0], second[0], first[1], first[2], second[1]};
      for (std::size_t i = 1; i < given.size(); ++i) {
        repeated += given.at(i) == given.at(i - 1) ? 1.0 : 0.0;
        last_right += given.at(i) == static_cast<int>(observed.right[i - 1]) ? 1.0 : 0.0;
      }
    }
  }
  const SerialDependence found = serial_dependence({observed}, 99, 1);
  CHECK(found.repeated_answer.expected == Approx(repeated / 6.0 / 4.0));
  CHECK(found.last_right.expected == Approx(last_right / 6.0 / 4.0));
}
