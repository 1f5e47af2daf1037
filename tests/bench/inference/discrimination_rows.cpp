#include <fmt/format.h>

#include <cmath>

#include "analysis/report/blocks/discrimination.hpp"
#include "analysis/statistics/detection/rates.hpp"
#include "inference/people.hpp"
#include "inference/rows.hpp"
namespace tapstudy::bench {
namespace {
using results::AnswerRow;

struct Discrimination {
  std::size_t places{2};  // where what is right may be, each equally often in a repetition
  int each{};             // time in a repetition
  int repetitions{};
  bool has_exclusions{};  // some stop half way, and who is wrong in 3 of 4 catch trials is left out
};

results::AlternativeRow alternative(std::size_t place, bool is_comparison) {
  const std::string label(1, static_cast<char>('A' + place));
  return {
      static_cast<int>(place), label, is_comparison ? "changed" : "standard", {}, is_comparison};
}

AnswerRow answer_of(std::size_t given, std::size_t right, const Discrimination& of) {
  AnswerRow answer;
  answer.response = std::string(1, static_cast<char>('A' + given));
  answer.is_correct = given == right;
  for (std::size_t place = 0; of.places > 2 && place < of.places; ++place) {
    answer.alternatives.push_back(alternative(place, place == right));
  }
  return answer;
}

bool fails_catch_trials(Guesser guesser, std::size_t places, core::Rng& rng) {
  std::optional<std::size_t> last;
  int right = 0;
  for (const std::size_t of_trial : shuffled(places, static_cast<int>(4 / places), rng)) {
    last = guess(guesser, places, last, rng);
    right += *last == of_trial ? 1 : 0;
  }
  return right < 2;
}

std::vector<AnswerRow> answers_of(const Discrimination& of, const StudyDraw& draw) {
  std::vector<AnswerRow> answers;
  for (int person = 0; person < draw.people;) {
    if (of.has_exclusions && fails_catch_trials(draw.guesser, of.places, draw.rng)) {
      continue;
    }
    const bool stops = of.has_exclusions && draw.rng.below(3) == 0;
    int left = of.each * static_cast<int>(of.places) * of.repetitions / (stops ? 2 : 1);
    std::optional<std::size_t> last;
    for (int repetition = 1; repetition <= of.repetitions; ++repetition) {
      for (const std::size_t right : shuffled(of.places, of.each, draw.rng)) {
        if (left-- > 0) {
          last = guess(draw.guesser, of.places, last, draw.rng);
          answers.push_back(answer_of(*last, right, of));
          answers.back().participant_id = fmt::format("p{}", person);
          answers.back().repetition = repetition;
        }
      }
    }
    ++person;
  }
  return answers;
}

Row against_chance(const char* task, const char* words, const Discrimination& of) {
  return {Kind::size, task, fmt::format("right answers against chance, {}", words), By::guessers,
          [of](const StudyDraw& draw) -> std::optional<Outcome> {
            analysis::BlockDesign design;
            design.guess_rate = 1.0 / static_cast<double>(of.places);
            const auto tables = analysis::places_redrawn(design, answers_of(of, draw));
            return accuracy_against(tables.value(), draw.rng());
          }};
}

// One guesser's right answers, by the places of 2 N repetitions of 4 trials.
std::optional<Outcome> one_guesser(const StudyDraw& draw) {
  analysis::BlockDesign design;
  design.guess_rate = 0.5;
  StudyDraw of_one{1, draw.rng, draw.guesser};
  const auto answers = answers_of({2, 2, 2 * draw.people, false}, of_one);
  return accuracy_against(analysis::places_redrawn(design, answers).value(), draw.rng());
}

// One person's d' = 1.5 by hits and false alarms of 10 N trials each, by independent observations.
std::optional<Outcome> sensitivity_by_rates(const StudyDraw& draw) {
  constexpr double d_prime = 1.5;
  const auto cdf = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
  const auto hits = answered(cdf(0.5 * d_prime - 0.2), 10 * draw.people, draw.rng);
  const auto false_alarms = answered(cdf(-0.5 * d_prime - 0.2), 10 * draw.people, draw.rng);
  return holds(analysis::yes_no_sensitivity(hits, false_alarms).d_prime_interval, d_prime);
}

std::optional<Outcome> criterion_by_rates(const StudyDraw& draw) {
  constexpr double z[]{0.5, -0.9};
  const auto cdf = [](double at) { return 0.5 * std::erfc(-at / std::sqrt(2.0)); };
  const auto hits = answered(cdf(z[0]), 10 * draw.people, draw.rng);
  const auto false_alarms = answered(cdf(z[1]), 10 * draw.people, draw.rng);
  return holds(analysis::yes_no_sensitivity(hits, false_alarms).criterion_interval,
               -0.5 * (z[0] + z[1]));
}

// One person's d' = 2 by pairs that differ and pairs that are alike.
std::optional<Outcome> sensitivity_by_pairs(const StudyDraw& draw, bool is_differencing) {
  constexpr double d_prime = 2.0;
  constexpr double false_rate = 0.25;
  const auto false_alarms = answered(false_rate, 10 * draw.people, draw.rng);
  if (is_differencing) {
    const double hit_rate = analysis::same_different_hit_rate(d_prime, false_rate);
    const auto interval = analysis::same_different_differencing_interval(
        answered(hit_rate, 10 * draw.people, draw.rng), false_alarms);
    return interval ? std::optional{holds(*interval, d_prime)} : std::nullopt;
  }
  // unbiased: as many right answers of pairs that differ as of those that are alike
  const double right = analysis::proportion_correct(
      {analysis::DecisionModel::same_different_independent_observation, 2}, d_prime);
  const auto interval = analysis::same_different_independent_interval(
      answered(right, 10 * draw.people, draw.rng),
      answered(1.0 - right, 10 * draw.people, draw.rng));
  return interval ? std::optional{holds(*interval, d_prime)} : std::nullopt;
}

std::optional<Outcome> share_of_one(const StudyDraw& draw) {
  return holds(analysis::wilson_interval(answered(0.8, 10 * draw.people, draw.rng)), 0.8);
}
}  // namespace

std::vector<Row> rows_of_discrimination() {
  constexpr const char* two = "comparison, same_different, abx, match_to_sample";
  return {
      against_chance(two, "2 repetitions of one comparison", {2, 1, 2, false}),
      against_chance(two, "4 repetitions of 4 trials", {2, 2, 4, false}),
      against_chance(two, "the same, exclusions, some stop", {2, 2, 4, true}),
      against_chance("odd_one_out", "4 repetitions of 3 trials", {3, 1, 4, false}),
      {Kind::size, two, "one participant's right answers, 8 N trials", By::guessers, one_guesser},
      {Kind::coverage, two, "one participant's share (Wilson), 10 N trials", By::people,
       share_of_one},
      {Kind::coverage, "same_different", "one participant's d' by rates, 10 N trials of each kind",
       By::people, sensitivity_by_rates},
      {Kind::coverage, "same_different", "one participant's criterion by rates, likewise",
       By::people, criterion_by_rates},
      {Kind::coverage, "same_different", "one participant's d' by differencing, likewise",
       By::people, [](const StudyDraw& draw) { return sensitivity_by_pairs(draw, true); }},
      {Kind::coverage, "same_different",
       "one participant's d' by independent observations, likewise", By::people,
       [](const StudyDraw& draw) { return sensitivity_by_pairs(draw, false); }},
  };
}
}  // namespace tapstudy::bench
