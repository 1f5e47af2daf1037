#include "analysis/report/blocks/choices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "analysis/report/document/formats.hpp"
#include "analysis/report/document/wording.hpp"
#include "analysis/statistics/numerics.hpp"
#include "analysis/statistics/proportion.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using results::AlternativeRow;
using results::AnswerRow;

std::optional<std::size_t> chosen_position(const AnswerRow& answer) {
  const auto found =
      std::ranges::find(answer.alternatives, answer.response, &AlternativeRow::stimulus);
  return found == answer.alternatives.end()
             ? std::nullopt
             : std::optional{static_cast<std::size_t>(found - answer.alternatives.begin())};
}

void count_visited(const VisitOrder& order, std::size_t chosen, std::size_t alternatives,
                   ChoiceBiases& biases) {
  const std::set<int> visited(order.positions.begin(), order.positions.end());
  if (visited.size() < alternatives) {
    return;
  }
  const int position = static_cast<int>(chosen);
  biases.first_visited.add(order.positions.front() == position);
  biases.last_visited.add(order.positions.back() == position);
}

std::map<std::int64_t, const VisitOrder*> by_trial(const BlockRows& rows) {
  std::map<std::int64_t, const VisitOrder*> orders;
  for (const VisitOrder& order : rows.orders) {
    orders[order.trial_id] = &order;
  }
  return orders;
}
}  // namespace

ChoiceBiases choice_biases(const BlockRows& rows) {
  ChoiceBiases biases;
  const auto orders = by_trial(rows);
  for (const AnswerRow& answer : rows.answers) {
    const std::optional<std::size_t> chosen = chosen_position(answer);
    if (!chosen) {
      continue;
    }
    if (biases.labels.empty()) {
      for (const AlternativeRow& alternative : answer.alternatives) {
        biases.labels.push_back(alternative.label);
      }
      biases.chosen.assign(biases.labels.size(), 0);
      biases.chance = 1.0 / static_cast<double>(biases.labels.size());
    }
    if (answer.alternatives.size() != biases.labels.size()) {
      throw core::InvalidInput{"block '" + answer.block +
                               "': trials differ in their number of alternatives"};
    }
    ++biases.chosen[*chosen];
    if (const auto order = orders.find(answer.trial_id); order != orders.end()) {
      count_visited(*order->second, *chosen, biases.labels.size(), biases);
    }
  }
  if (!biases.chosen.empty()) {
    biases.labels_p = exact_multinomial_p(biases.chosen);
  }
  return biases;
}

std::vector<std::vector<std::int64_t>> transitions(const std::vector<Item>& stimuli,
                                                   const BlockRows& rows) {
  std::vector<std::vector<std::int64_t>> counts(stimuli.size(),
                                                std::vector<std::int64_t>(stimuli.size(), 0));
  const auto orders = by_trial(rows);
  for (const AnswerRow& answer : rows.answers) {
    const auto order = orders.find(answer.trial_id);
    if (order == orders.end()) {
      continue;
    }
    std::vector<std::size_t> visited;
    for (const int position : order->second->positions) {
      const std::string& name = answer.alternatives.at(static_cast<std::size_t>(position)).stimulus;
      visited.push_back(static_cast<std::size_t>(std::ranges::find(stimuli, name, &Item::name) -
                                                 stimuli.begin()));
    }
    for (std::size_t i = 1; i < visited.size(); ++i) {
      if (visited[i - 1] < stimuli.size() && visited[i] < stimuli.size()) {
        ++counts[visited[i - 1]][visited[i]];
      }
    }
  }
  return counts;
}

double binomial_two_sided_p(const Proportion& observed, double chance) {
  constexpr double rounding = 1e-7;  // outcomes so close in probability are equally likely
  const auto log_probability = [&](std::int64_t k) {
    const std::int64_t n = observed.trials;
    return log_factorial(n) - log_factorial(k) - log_factorial(n - k) +
           static_cast<double>(k) * std::log(chance) +
           static_cast<double>(n - k) * std::log1p(-chance);
  };
  const double limit = log_probability(observed.successes) + rounding;
  double p = 0.0;
  for (std::int64_t k = 0; k <= observed.trials; ++k) {
    const double probability = log_probability(k);
    p += probability <= limit ? std::exp(probability) : 0.0;
  }
  return std::min(1.0, p);
}

namespace {
ReportTable biases_table(const ChoiceBiases& biases) {
  ReportTable table{
      "biases",
      "Choices by label and by order of visits, all trials",
      {column("chosen was", "chosen_was"), column("label", "label"),
       counted_column("of trials", "chosen"), column("by chance", "chance"), column("p", "p")}};
  std::int64_t trials = 0;
  for (const int chosen : biases.chosen) {
    trials += chosen;
  }
  for (std::size_t i = 0; i < biases.labels.size(); ++i) {
    table.rows.push_back({word("under the label"), word(biases.labels[i]),
                          counted({biases.chosen[i], trials}), share(biases.chance),
                          i == 0 ? probability(biases.labels_p) : nothing(table.columns[4], "")});
  }
  const auto add_visited = [&](const char* what, const Proportion& chosen) {
    if (chosen.trials > 0) {
      table.rows.push_back({word(what), nothing(table.columns[1], ""), counted(chosen),
                            share(biases.chance),
                            probability(binomial_two_sided_p(chosen, biases.chance))});
    }
  };
  add_visited("visited first", biases.first_visited);
  add_visited("visited last", biases.last_visited);
  return table;
}

ReportTable transitions_table(const std::vector<Item>& stimuli, const BlockRows& rows) {
  ReportTable table{
      "transitions", "Switches while exploring: rows from, columns to", {column("from", "from")}};
  for (const Item& item : stimuli) {
    table.columns.push_back(column(item.label, item.name));
  }
  if (rows.orders.empty()) {
    return table;
  }
  const auto counts = transitions(stimuli, rows);
  for (std::size_t i = 0; i < stimuli.size(); ++i) {
    std::vector<Cell> row{labelled(stimuli[i])};
    for (const std::int64_t switches : counts[i]) {
      row.push_back(count(switches));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string missing_words(const BlockRows& rows) {
  const auto answered = static_cast<int>(rows.answers.size());
  return rows.missing_replies == 0
             ? fmt::format("No reply is missing of {} trials that were presented.", answered)
             : fmt::format(
                   "Missing replies: {} of {} trials that were presented timed out or were "
                   "skipped, and not answered later. They are in no count.",
                   rows.missing_replies, answered + rows.missing_replies);
}
}  // namespace

ReportSection choosing_section(const BlockDesign& design, const BlockRows& rows) {
  ReportSection section{"How it was chosen"};
  const ChoiceBiases biases = choice_biases(rows);
  section.remarks.push_back(missing_words(rows));
  if (biases.labels.empty()) {
    return section;
  }
  section.tables = {biases_table(biases), transitions_table(design.stimuli, rows)};
  section.remarks.emplace_back(
      "Labels are drawn anew for each trial: without a bias all are equally likely (exact "
      "multinomial test, outcomes by probability), and of trials in which all were visited the "
      "first or last was chosen by chance in one of so many as there are (exact binomial, "
      "two-sided). What was visited last may have been visited again because it was preferred.");
  return section;
}

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

namespace {
// Each alternative alone: a participant has one vote.
std::vector<MainResult> shares_chosen(const std::vector<AlternativeResult>& alternatives) {
  std::vector<MainResult> shares;
  for (const AlternativeResult& alternative : alternatives) {
    if (alternative.chosen.trials > 0) {
      shares.push_back({"chosen: " + alternative.item.label, alternative.chosen.value(),
                        wilson_interval(alternative.chosen)});
    }
  }
  return shares;
}

// "7/10 = 70 % (95 % CI 34–91 %)", the interval that of all alternatives at once.
Cell chosen_cell(const AlternativeResult& result, double chance) {
  const auto end = [](const std::optional<Interval>& interval, double Interval::*which) {
    return interval ? Value{(*interval).*which} : Value{};
  };
  Cell cell{fraction(result.chosen),
            {result.chosen.successes, result.chosen.trials, end(result.interval, &Interval::low),
             end(result.interval, &Interval::high)}};
  if (result.interval) {
    cell.text = fmt::format("{} (95 % CI {})", fraction_and_percent(result.chosen),
                            percent_range(*result.interval));
    cell.dot = Dot{result.chosen.value(), *result.interval, chance};
  }
  return cell;
}

ReportTable choices_table(const std::vector<AlternativeResult>& alternatives) {
  ReportTable table{"choices",
                    "Choices",
                    {column("stimulus", "stimulus"),
                     {"chosen", {"votes", "voters", "goodman_low", "goodman_high"}},
                     column("visits", "visits"),
                     column("time tried", "dwell_s")}};
  table.shown_in.json = false;  // which has them as `alternatives`
  table.note =
      core::citing("Intervals: 95 %, of all alternatives at once ({}).", "Goodman 1965"_source);
  for (const AlternativeResult& result : alternatives) {
    table.rows.push_back({labelled(result.item),
                          chosen_cell(result, 1.0 / static_cast<double>(alternatives.size())),
                          count(result.visits),
                          {fmt::format("{:.1f} s", result.dwell_s), {result.dwell_s}}});
  }
  return table;
}

// The p value of the votes and its test, or why there is none.
std::string remark_on_votes(const ChoiceSummary& summary) {
  std::string remark = "All alternatives equally likely: ";
  if (!summary.untested.empty()) {
    remark += "not tested: " + summary.untested + ".";
  } else if (summary.multinomial_p) {
    remark += p_value(*summary.multinomial_p) + " (exact multinomial, outcomes by probability).";
  } else {
    remark += "not computed, too many possible outcomes.";
  }
  if (summary.has_repeated_choices) {
    remark +=
        fmt::format(" Of {} choices each participant has one vote: {}.", summary.choices.size(),
                    summary.vote == Vote::first ? "the first choice"
                                                : "the most frequent choice, of equals the first");
  }
  return remark;
}

using Json = nlohmann::ordered_json;

Json values_of(const ChoiceSummary& summary) {
  const auto ends = [](const std::optional<Interval>& interval) {
    return interval ? Json{interval->low, interval->high} : Json(nullptr);
  };
  Json json{{"alternatives", Json::array()}, {"choices", Json::array()}};
  for (const AlternativeResult& result : summary.alternatives) {
    json["alternatives"].push_back({{"stimulus", result.item.name},
                                    {"chosen", as_json(result.chosen)},
                                    {"goodman_95", ends(result.interval)},
                                    {"visits", result.visits},
                                    {"dwell_s", result.dwell_s}});
  }
  for (const auto& [participant, stimulus] : summary.choices) {
    json["choices"].push_back({{"participant_id", participant}, {"stimulus", stimulus}});
  }
  json["exact_multinomial_p"] =
      summary.multinomial_p ? Json(*summary.multinomial_p) : Json(nullptr);
  json["has_repeated_choices"] = summary.has_repeated_choices;
  return json;
}
}  // namespace

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
    for (std::size_t i = 0; i < intervals.size(); ++i) {
      summary->alternatives[i].interval = intervals[i];
    }
  }
  if (summary->untested.empty()) {
    summary->multinomial_p = exact_multinomial_p(counts);
  }
  for (const PlannedHypothesis& planned : design.hypotheses) {
    summary->hypotheses.push_back(tested(*summary, planned));
  }
  if (summary->untested.empty()) {
    summary->methods =
        "Choices are tested by the exact binomial and multinomial distributions, one vote a "
        "participant.";
  }
  summary->main_results = shares_chosen(summary->alternatives);
  summary->results().tables = {choices_table(summary->alternatives)};
  summary->results().remarks = {remark_on_votes(*summary)};
  summary->values = std::make_shared<const Json>(values_of(*summary));
  summary->sections.push_back(choosing_section(design, rows));
  return summary;
}
}  // namespace tapstudy::analysis
