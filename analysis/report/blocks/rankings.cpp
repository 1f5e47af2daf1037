#include "analysis/report/blocks/rankings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "analysis/report/blocks/ratings.hpp"
#include "analysis/report/blocks/scale_intervals.hpp"
#include "analysis/report/document/sections.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;

Ranking ranking_of(const BlockDesign& design, const AnswerRow& answer) {
  std::istringstream words{answer.response};
  Ranking ranking;
  for (std::string name; words >> name;) {
    const auto found = std::ranges::find(design.stimuli, name, &Item::name);
    ranking.push_back(static_cast<std::size_t>(found - design.stimuli.begin()));
  }
  if (!is_ranking(ranking, design.stimuli.size())) {
    throw core::InvalidInput{
        fmt::format("block '{}', {} in trial {}: '{}' does not name every stimulus once",
                    design.name, answer.participant_id, answer.number, answer.response)};
  }
  return ranking;
}

// Of each stimulus, over one participant's rankings.
std::vector<double> mean_places(const std::vector<Ranking>& rankings, std::size_t stimuli) {
  std::vector<double> means(stimuli, 0.0);
  for (const Ranking& ranking : rankings) {
    for (std::size_t place = 0; place < ranking.size(); ++place) {
      means[ranking[place]] += static_cast<double>(place + 1);
    }
  }
  for (double& mean : means) {
    mean /= static_cast<double>(rankings.size());
  }
  return means;
}

void add_tests(const BlockDesign& design, RankingResults& results) {
  results.no_tests = design.premise;
  if (!design.premise.empty()) {
    return;
  }
  try {
    results.friedman = friedman_test(results.mean_places, friedman_seed);
    results.pairwise = pairwise_signed_rank(results.mean_places);
  } catch (const core::NotEstimable& error) {  // too few participants
    results.no_tests = error.what();
  }
}

void add_worths(const std::map<std::string, std::vector<Ranking>>& people,
                RankingResults& results) {
  std::vector<std::vector<Ranking>> rankings;
  for (const auto& [name, own] : people) {
    rankings.push_back(own);
  }
  try {
    results.worths = plackett_luce(rankings, results.stimuli.size());
  } catch (const core::NotEstimable& error) {  // a stimulus that was never behind another
    results.no_worths = error.what();
  }
}
}  // namespace

RankingResults ranking_results(const BlockDesign& design, const std::vector<AnswerRow>& answers) {
  RankingResults results;
  const std::size_t count = design.stimuli.size();
  std::ranges::transform(design.stimuli, std::back_inserter(results.stimuli), &Item::name);
  results.places.assign(count, std::vector<int>(count, 0));
  std::map<std::string, std::vector<Ranking>> people;
  for (const AnswerRow& answer : answers) {
    const Ranking ranking = ranking_of(design, answer);
    for (std::size_t place = 0; place < count; ++place) {
      ++results.places[ranking[place]][place];
    }
    ++results.rankings;
    people[answer.participant_id].push_back(ranking);
  }
  for (const auto& [name, rankings] : people) {
    results.participants.push_back(name);
    results.mean_places.push_back(mean_places(rankings, count));
  }
  add_tests(design, results);
  add_worths(people, results);
  return results;
}

namespace {
double mean_place(const std::vector<int>& counts) {
  double sum = 0.0;
  double all = 0.0;
  for (std::size_t place = 0; place < counts.size(); ++place) {
    sum += counts[place] * static_cast<double>(place + 1);
    all += counts[place];
  }
  return sum / all;
}

ReportTable stimuli_table(const RankingResults& results) {
  const Column of_worth = interval_column(
      fmt::format("log worth ({})", words_of_scale_interval(results.participants.size())),
      "log_worth");
  ReportTable table{"stimuli",
                    "Places of each stimulus; 1 is the best",
                    {column("stimulus", "stimulus"), column("mean place", "mean_place"), of_worth}};
  for (std::size_t place = 1; place <= results.stimuli.size(); ++place) {
    table.columns.push_back(column(fmt::format("{}", place), fmt::format("place_{}", place)));
  }
  for (std::size_t i = 0; results.rankings > 0 && i < results.stimuli.size(); ++i) {
    const auto& worths = results.worths;
    std::vector<Cell> row{
        word(results.stimuli[i]), number(mean_place(results.places[i])),
        worths ? interval(worths->values[static_cast<Eigen::Index>(i)], worths->intervals[i])
               : nothing(of_worth)};
    std::ranges::transform(results.places[i], std::back_inserter(row), count);
    table.rows.push_back(row);
  }
  return table;
}

ReportTable pairs_table(const RankingResults& results) {
  const Column of_difference =
      interval_column(fmt::format("log worth, difference ({})",
                                  words_of_scale_interval(results.participants.size())),
                      "difference");
  ReportTable table{
      "pairs",
      core::citing("Pairs of stimuli: signed-rank tests ({}) of participants' mean places",
                   "Wilcoxon 1945"_source),
      {column("first", "first"), column("second", "second"), of_difference, column("p", "p"),
       column("by Holm", "p_holm"), column("exact", "is_exact")}};
  for (const PairwiseTest& pair : results.pairwise) {
    Cell of_worths = nothing(of_difference);
    if (results.worths) {
      const ScaleDifference worths =
          difference(*results.worths, static_cast<Eigen::Index>(pair.first),
                     static_cast<Eigen::Index>(pair.second));
      of_worths = interval(worths.value, worths.interval);
    }
    table.rows.push_back({word(results.stimuli[pair.first]), word(results.stimuli[pair.second]),
                          of_worths, probability(pair.test.p), probability(pair.adjusted_p),
                          flag(pair.test.is_exact)});
  }
  return table;
}

std::vector<CitingText> remarks_on(const RankingResults& results) {
  if (results.rankings == 0) {
    return {"There are no answers."};
  }
  std::vector<CitingText> remarks{
      results.no_worths.empty()
          ? core::citing(
                "Worths ({}; {}): each place goes to one of the stimuli that are left in "
                "proportion to its worth. Natural logarithms, mean 0, by maximum likelihood.",
                "Plackett 1975"_source, "Luce 1959"_source)
          : core::citing("There are no worths: {}.", results.no_worths),
      results.no_tests.empty()
          ? core::citing("Tests take the mean of each participant's places of a stimulus. {} "
                         "Two-sided p of pairs, and the same adjusted for their number ({}).",
                         words_of_permutation, "Holm 1979"_source)
          : core::citing("Not tested: {}.", results.no_tests)};
  if (results.no_worths.empty()) {
    remarks.push_back(remark_on_scale_interval(results.participants.size()));
  }
  return remarks;
}
}  // namespace

std::shared_ptr<BlockSummary> summarise_rankings(const BlockDesign& design, const BlockRows& rows) {
  const RankingResults results = ranking_results(design, rows.answers);
  auto summary = std::make_shared<BlockSummary>(design);
  summary->results().tables = {
      stimuli_table(results), friedman_table(results.friedman, results.participants.size()),
      pairs_table(results),
      participant_values_table("Mean places of each participant",
                               column("mean place", "mean_place"), results.participants,
                               results.stimuli, results.mean_places)};
  summary->main_results =
      means_over_participants("mean place", results.stimuli, results.mean_places,
                              {1.0, static_cast<double>(results.stimuli.size())});
  summary->results().remarks = remarks_on(results);
  return summary;
}
}  // namespace tapstudy::analysis
