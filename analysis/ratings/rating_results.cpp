#include "analysis/ratings/rating_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/error.hpp"
#include "core/number_in.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;
// Of each stimulus, by its place in the block.
using RatingsByStimulus = std::vector<std::vector<double>>;

std::optional<double> rating_in(const std::string& response, int steps) {
  if (steps == 0) {
    const auto mark = core::number_in<double>(response);
    return mark && *mark >= 0.0 && *mark <= 1.0 ? mark : std::nullopt;
  }
  const auto step = core::number_in<int>(response);
  return step && *step >= 1 && *step <= steps ? step : std::nullopt;
}

double rating_of(const BlockDesign& design, const AnswerRow& answer) {
  const std::optional<double> rating = rating_in(answer.response, design.steps);
  if (!rating) {
    throw core::InvalidInput{
        fmt::format("block '{}', {} in trial {}: a rating is {}, not '{}'", design.name,
                    answer.participant_id, answer.number,
                    design.steps == 0 ? "a number from 0 to 1"
                                      : fmt::format("a whole number from 1 to {}", design.steps),
                    answer.response)};
  }
  return *rating;
}

std::size_t stimulus_of(const BlockDesign& design, const AnswerRow& answer) {
  const auto found = std::ranges::find(design.stimuli, answer.stimulus, &Item::name);
  if (found == design.stimuli.end()) {
    throw core::InvalidInput{fmt::format("block '{}', {} in trial {}: there is no stimulus '{}'",
                                         design.name, answer.participant_id, answer.number,
                                         answer.stimulus)};
  }
  return static_cast<std::size_t>(found - design.stimuli.begin());
}

StimulusRatings described(const std::string& name, const std::vector<double>& ratings, int steps) {
  StimulusRatings result{name, std::vector<int>(static_cast<std::size_t>(steps)), {}};
  for (const double rating : steps == 0 ? std::vector<double>{} : ratings) {
    ++result.counts.at(static_cast<std::size_t>(rating) - 1);
  }
  if (!ratings.empty()) {
    result.quartiles = quartiles(ratings);
  }
  return result;
}

// Means of two marks that are equal but for rounding are ties.
double rounded(double median) {
  constexpr double digits = 1e9;
  return std::round(digits * median) / digits;
}

void add_medians(RatingResults& results, const std::string& name,
                 const RatingsByStimulus& ratings) {
  if (std::ranges::any_of(ratings, &std::vector<double>::empty)) {
    results.left_out.push_back(name);
    return;
  }
  results.participants.push_back(name);
  results.medians.emplace_back();
  for (const std::vector<double>& of_stimulus : ratings) {
    results.medians.back().push_back(rounded(quantile(of_stimulus, 0.5)));
  }
}

void add_tests(RatingResults& results) {
  try {
    results.friedman = friedman_test(results.medians);
    results.pairwise = pairwise_signed_rank(results.medians);
  } catch (const core::NotEstimable& error) {  // too few participants or stimuli, or all alike
    results.no_tests = error.what();
  }
}
}  // namespace

RatingResults rating_results(const BlockDesign& design, const std::vector<AnswerRow>& answers) {
  if (design.steps == 1) {
    throw core::InvalidInput{
        fmt::format("block '{}': a rating has two steps or more", design.name)};
  }
  const RatingsByStimulus none(design.stimuli.size());
  RatingsByStimulus all = none;
  std::map<std::string, RatingsByStimulus> people;
  for (const AnswerRow& answer : answers) {
    const std::size_t stimulus = stimulus_of(design, answer);
    const double rating = rating_of(design, answer);
    all[stimulus].push_back(rating);
    people.try_emplace(answer.participant_id, none).first->second[stimulus].push_back(rating);
  }
  RatingResults results;
  for (std::size_t i = 0; i < design.stimuli.size(); ++i) {
    results.stimuli.push_back(described(design.stimuli[i].name, all[i], design.steps));
  }
  for (const auto& [name, ratings] : people) {
    add_medians(results, name, ratings);
  }
  if (design.premise.empty()) {
    add_tests(results);
  } else {
    results.no_tests = design.premise;
  }
  return results;
}
}  // namespace tapstudy::analysis
