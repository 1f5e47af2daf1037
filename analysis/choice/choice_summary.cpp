#include "analysis/choice/choice_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "analysis/statistics/simultaneous.hpp"
#include "analysis/statistics/sison_glaz.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
// Choices of one participant are not independent of one another: each participant has one vote.
std::vector<std::string> votes_of(std::vector<results::AnswerRow> answers, Vote vote) {
  std::ranges::stable_sort(answers, {}, &results::AnswerRow::trial_id);
  std::vector<std::string> participants;
  std::map<std::string, std::vector<std::string>> chosen;
  for (const results::AnswerRow& answer : answers) {
    auto& of_participant = chosen[answer.participant_id];
    if (of_participant.empty()) {
      participants.push_back(answer.participant_id);
    }
    of_participant.push_back(answer.response);
  }
  std::vector<std::string> votes;
  for (const std::string& participant : participants) {
    const auto& all = chosen[participant];
    if (vote == Vote::first) {
      votes.push_back(all.front());
      continue;
    }
    votes.push_back(*std::ranges::max_element(
        all, {}, [&](const std::string& response) { return std::ranges::count(all, response); }));
  }
  return votes;
}

AlternativeResult result_of(const Item& item, const std::vector<std::string>& votes,
                            const BlockRows& rows) {
  AlternativeResult result{
      item,
      {std::ranges::count(votes, item.name), static_cast<std::int64_t>(votes.size())},
      std::nullopt,
      0,
      0.0};
  for (const results::VisitRow& visit : rows.visits) {
    if (visit.stimulus == item.name) {
      result.visits += visit.visits;
      result.dwell_s += visit.dwell_s;
    }
  }
  return result;
}

HypothesisResult tested(const ChoiceSummary& summary, const PlannedHypothesis& planned) {
  const auto expected = std::ranges::find_if(
      summary.alternatives,
      [&](const AlternativeResult& result) { return result.item.name == planned.stimulus; });
  if (expected == summary.alternatives.end()) {
    throw core::InvalidInput{fmt::format(
        "block '{}': hypothesis '{}' names no stimulus of the block", summary.block, planned.name)};
  }
  const double chance = 1.0 / static_cast<double>(summary.alternatives.size());
  HypothesisResult result{planned, "", expected->chosen, chance, {}, 0.0};
  if (!summary.untested.empty()) {
    result.test = summary.untested;
  } else {
    result.test = summary.has_repeated_choices ? "exact binomial, one vote a participant, one-sided"
                                               : "exact binomial, one-sided";
    result.p = binomial_p_at_least(expected->chosen, chance);
  }
  return result;
}
}  // namespace

std::vector<MainResult> ChoiceSummary::main_results() const {
  std::vector<MainResult> shares;
  for (const AlternativeResult& alternative : alternatives) {
    if (alternative.chosen.trials > 0) {
      shares.push_back({"chosen: " + alternative.item.label, alternative.chosen.value(),
                        wilson_interval(alternative.chosen)});
    }
  }
  return shares;
}

std::shared_ptr<BlockSummary> summarise_choice(const BlockDesign& design, const BlockRows& rows) {
  const std::vector<results::AnswerRow>& answers = rows.answers;
  auto summary = std::make_shared<ChoiceSummary>(design);
  for (const results::AnswerRow& answer : answers) {
    summary->choices.emplace_back(answer.participant_id, answer.response);
  }
  const std::vector<std::string> votes = votes_of(answers, design.vote);
  summary->vote = design.vote;
  summary->has_repeated_choices = votes.size() < answers.size();
  summary->untested = !design.premise.empty() ? design.premise
                      : answers.empty()       ? "there are no answers"
                                              : "";
  std::vector<int> counts;
  for (const Item& item : design.stimuli) {
    summary->alternatives.push_back(result_of(item, votes, rows));
    counts.push_back(static_cast<int>(summary->alternatives.back().chosen.successes));
  }
  if (!votes.empty() && counts.size() > 1) {
    const std::vector<Interval> intervals = simultaneous_intervals(counts);
    const std::vector<Interval> others = sison_glaz_intervals(counts);
    for (std::size_t i = 0; i < intervals.size(); ++i) {
      summary->alternatives[i].interval = intervals[i];
      summary->alternatives[i].sison_glaz = others[i];
    }
  }
  if (summary->untested.empty()) {
    summary->multinomial_p = exact_multinomial_p(counts);
  }
  for (const PlannedHypothesis& planned : design.hypotheses) {
    summary->hypotheses.push_back(tested(*summary, planned));
  }
  summary->sections = {choosing_section(design, rows)};
  return summary;
}

std::string ChoiceSummary::methods() const {
  return untested.empty()
             ? "Choices are tested by the exact binomial and multinomial distributions, one vote a "
               "participant."
             : std::string{};
}
}  // namespace tapstudy::analysis
