#include "analysis/ratings/rating_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "analysis/ratings/friedman_table.hpp"
#include "analysis/ratings/participant_values_table.hpp"
#include "analysis/ratings/rating_results.hpp"
#include "analysis/statistics/sign_test.hpp"
#include "analysis/tables/tabular_summary.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
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
  ReportTable table{"pairs",
                    "Pairs of stimuli: signed-rank tests (Wilcoxon 1945)",
                    {column("first", "first"), column("second", "second"), column("V", "v"),
                     column("pairs that differ", "differing"), column("p", "p"),
                     column("by Holm", "p_holm"), column("exact", "is_exact")}};
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

std::vector<std::string> remarks_on(const RatingResults& results) {
  if (results.participants.empty() && results.left_out.empty()) {
    return {"There are no answers."};
  }
  std::vector<std::string> remarks{
      "Medians and quartiles (and counts of steps) are of all ratings. Tests take the median of "
      "each participant's ratings of a stimulus; ranks count from the lowest rating."};
  if (!results.left_out.empty()) {
    remarks.push_back(fmt::format("Left out of tests, without ratings of every stimulus: {}.",
                                  fmt::join(results.left_out, ", ")));
  }
  remarks.push_back(
      results.no_tests.empty()
          ? "Two-sided p of pairs, and the same adjusted for their number (Holm 1979)."
          : "Not tested: " + results.no_tests + ".");
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
  auto summary = std::make_shared<TabularSummary>(design);
  summary->parts = {stimuli_table(design, results),
                    friedman_table(results.friedman, results.participants.size()),
                    pairs_table(results), participants_table(results)};
  std::vector<std::string> stimuli;
  std::ranges::transform(results.stimuli, std::back_inserter(stimuli), &StimulusRatings::stimulus);
  summary->main =
      means_over_participants("mean of participants' median ratings", stimuli, results.medians);
  summary->remarks = remarks_on(results);
  for (const PlannedHypothesis& planned : design.hypotheses) {
    summary->hypotheses.push_back(tested(design, results, planned));
  }
  return summary;
}
}  // namespace tapstudy::analysis
