#include "analysis/report/blocks/ratings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>

#include "analysis/report/document/sections.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "analysis/statistics/rank_tests.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
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
    results.friedman = friedman_test(results.medians, friedman_seed);
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

ReportTable friedman_table(const std::optional<FriedmanTest>& test, std::size_t participants) {
  ReportTable table{
      "friedman",
      core::citing("Test of ranks over participants ({})", "Friedman 1937"_source),
      {column("participants", "participants"), column("chi squared", "chi_squared"),
       column("df", "degrees_of_freedom"), column("p by permutation", "p"),
       column("exact", "is_exact"),
       column(core::citing("W ({})", "Kendall & Babington Smith 1939"_source), "kendalls_w")}};
  if (test) {
    table.rows.push_back({count(static_cast<std::int64_t>(participants)), number(test->chi_squared),
                          number(test->degrees_of_freedom), probability(test->p),
                          flag(test->is_exact), number(test->kendalls_w)});
  }
  return table;
}

ReportTable participant_values_table(const std::string& title, const Column& of,
                                     const std::vector<std::string>& participants,
                                     const std::vector<std::string>& stimuli,
                                     const RatingTable& values) {
  ReportTable table{"participants",
                    title,
                    {column("participant", "participant_id"), column("stimulus", "stimulus"), of}};
  table.shown_in = programs_only;
  for (std::size_t person = 0; person < participants.size(); ++person) {
    for (std::size_t i = 0; i < stimuli.size(); ++i) {
      table.rows.push_back(
          {word(participants[person]), word(stimuli[i]), number(values[person][i])});
    }
  }
  return table;
}

std::vector<MainResult> means_over_participants(const std::string& what,
                                                const std::vector<std::string>& stimuli,
                                                const std::vector<std::vector<double>>& values,
                                                const Interval& bounds) {
  std::vector<MainResult> means;
  for (std::size_t i = 0; i < stimuli.size() && values.size() > 1; ++i) {
    std::vector<double> of_stimulus;
    for (const std::vector<double>& of_participant : values) {
      of_stimulus.push_back(of_participant[i]);
    }
    means.push_back({fmt::format("{}: {}", what, stimuli[i]),
                     mean_and_spread(of_stimulus).mean,
                     bounded_interval(of_stimulus, bounds),
                     {},
                     {},
                     false,
                     static_cast<int>(of_stimulus.size())});
  }
  return means;
}

namespace {
ReportTable stimuli_table(const BlockDesign& design, const RatingResults& results) {
  const Column of_quartiles{"median (quartiles)", {"median", "quartile_low", "quartile_high"}};
  ReportTable table{
      "stimuli",
      "Ratings of each stimulus",
      {column("stimulus", "stimulus"), of_quartiles, column("mean rank", "mean_rank")}};
  for (int step = 1; step <= design.steps; ++step) {
    table.columns.push_back(column(fmt::format("{}", step), fmt::format("rated_{}", step)));
  }
  for (std::size_t i = 0; i < results.stimuli.size(); ++i) {
    const StimulusRatings& of = results.stimuli[i];
    std::vector<Cell> row{
        word(of.stimulus),
        of.quartiles ? interval(of.quartiles->median, {of.quartiles->low, of.quartiles->high})
                     : nothing(of_quartiles),
        results.friedman ? number(results.friedman->mean_ranks[i]) : nothing(table.columns[2])};
    std::ranges::transform(of.counts, std::back_inserter(row), count);
    table.rows.push_back(row);
  }
  return table;
}

ReportTable pairs_table(const RatingResults& results) {
  ReportTable table{
      "pairs",
      core::citing("Pairs of stimuli: signed-rank tests ({})", "Wilcoxon 1945"_source),
      {column("first", "first"), column("second", "second"), column("V", "v"),
       column("pairs that differ", "differing"), column("p", "p"), column("by Holm", "p_holm"),
       column("exact", "is_exact")}};
  for (const PairwiseTest& pair : results.pairwise) {
    table.rows.push_back(
        {word(results.stimuli[pair.first].stimulus), word(results.stimuli[pair.second].stimulus),
         number(pair.test.positive_ranks), count(pair.test.pairs), probability(pair.test.p),
         probability(pair.adjusted_p), flag(pair.test.is_exact)});
  }
  return table;
}

ReportTable participants_table(const RatingResults& results) {
  std::vector<std::string> stimuli;
  std::ranges::transform(results.stimuli, std::back_inserter(stimuli), &StimulusRatings::stimulus);
  return participant_values_table("Median ratings of each participant", column("median", "median"),
                                  results.participants, stimuli, results.medians);
}

std::vector<CitingText> remarks_on(const RatingResults& results) {
  if (results.participants.empty() && results.left_out.empty()) {
    return {"There are no answers."};
  }
  std::vector<CitingText> remarks{
      "Medians and quartiles (and counts of steps) are of all ratings. Tests take the median of "
      "each participant's ratings of a stimulus; ranks count from the lowest rating."};
  if (!results.left_out.empty()) {
    remarks.push_back(fmt::format("Left out of tests, without ratings of every stimulus: {}.",
                                  fmt::join(results.left_out, ", ")));
  }
  remarks.push_back(
      results.no_tests.empty()
          ? core::citing("{} Two-sided p of pairs, and the same adjusted for their number ({}).",
                         words_of_permutation, "Holm 1979"_source)
          : core::citing("Not tested: {}.", results.no_tests));
  return remarks;
}

// The claim holds only if every difference does: the largest p is a test of it (intersection-union,
// Berger 1982).
void test_against_others(HypothesisResult& result, const RatingResults& results,
                         std::size_t expected) {
  std::string hardest;
  SignTest weakest{{}, -1.0};
  for (std::size_t other = 0; other < results.stimuli.size(); ++other) {
    if (other == expected) {
      continue;
    }
    std::vector<double> differences;
    for (const std::vector<double>& medians : results.medians) {
      differences.push_back(medians[expected] - medians[other]);
    }
    const SignTest test = sign_test(differences);
    if (test.p > weakest.p) {
      weakest = test;
      hardest = results.stimuli[other].stimulus;
    }
  }
  result.observed = weakest.above;
  if (weakest.above.trials == 0) {
    result.test = fmt::format("no participant's median differs between it and {}", hardest);
    return;
  }
  result.p = weakest.p;
  result.test = fmt::format(
      "exact sign tests of participants' medians, one-sided, against every other stimulus; the "
      "largest p, of {}",
      hardest);
}

HypothesisResult tested(const BlockDesign& design, const RatingResults& results,
                        const PlannedHypothesis& planned) {
  constexpr double half = 0.5;
  HypothesisResult result{planned, "", {}, half, {}, 0.0};
  const auto expected =
      std::ranges::find(results.stimuli, planned.stimulus, &StimulusRatings::stimulus);
  if (expected == results.stimuli.end()) {
    throw core::InvalidInput{fmt::format(
        "block '{}': hypothesis '{}' names no stimulus of the block", design.name, planned.name)};
  }
  if (!design.premise.empty()) {
    result.test = design.premise;
  } else if (results.participants.empty()) {
    result.test = "no participant rated every stimulus";
  } else if (results.stimuli.size() < 2) {
    result.test = "there is no other stimulus";
  } else {
    test_against_others(result, results,
                        static_cast<std::size_t>(expected - results.stimuli.begin()));
  }
  return result;
}
}  // namespace

std::shared_ptr<BlockSummary> summarise_ratings(const BlockDesign& design, const BlockRows& rows) {
  const RatingResults results = rating_results(design, rows.answers);
  auto summary = std::make_shared<BlockSummary>(design);
  summary->results().tables = {stimuli_table(design, results),
                               friedman_table(results.friedman, results.participants.size()),
                               pairs_table(results), participants_table(results)};
  std::vector<std::string> stimuli;
  std::ranges::transform(results.stimuli, std::back_inserter(stimuli), &StimulusRatings::stimulus);
  summary->main_results = means_over_participants(
      "mean of participants' median ratings", stimuli, results.medians,
      design.steps > 0 ? Interval{1.0, static_cast<double>(design.steps)} : Interval{0.0, 1.0});
  summary->results().remarks = remarks_on(results);
  for (const PlannedHypothesis& planned : design.hypotheses) {
    summary->hypotheses.push_back(tested(design, results, planned));
  }
  return summary;
}
}  // namespace tapstudy::analysis
