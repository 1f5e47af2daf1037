#include "analysis/rankings/ranking_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

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
    results.friedman = friedman_test(results.mean_places);
    results.pairwise = pairwise_signed_rank(results.mean_places);
  } catch (const core::NotEstimable& error) {  // too few participants
    results.no_tests = error.what();
  }
}

void add_worths(const std::vector<Ranking>& rankings, RankingResults& results) {
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
  std::vector<Ranking> all;
  std::map<std::string, std::vector<Ranking>> people;
  for (const AnswerRow& answer : answers) {
    const Ranking ranking = ranking_of(design, answer);
    for (std::size_t place = 0; place < count; ++place) {
      ++results.places[ranking[place]][place];
    }
    all.push_back(ranking);
    people[answer.participant_id].push_back(ranking);
  }
  results.rankings = static_cast<int>(all.size());
  for (const auto& [name, rankings] : people) {
    results.participants.push_back(name);
    results.mean_places.push_back(mean_places(rankings, count));
  }
  add_tests(design, results);
  add_worths(all, results);
  return results;
}
}  // namespace tapstudy::analysis
