#include "analysis/report/blocks/discrimination.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "analysis/report/document/sections.hpp"
#include "analysis/report/document/wording.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
ReportTable answer_counts_table(const std::vector<results::AnswerRow>& answers) {
  std::set<std::string> given;
  std::map<std::string, std::map<std::string, std::int64_t>> counts;
  std::map<std::string, std::int64_t> all;
  for (const results::AnswerRow& answer : answers) {
    given.insert(answer.response);
    ++counts[answer.participant_id][answer.response];
    ++all[answer.participant_id];
  }
  ReportTable table{"answer_counts",
                    "Answers that were given, each right equally often (bias)",
                    {column("participant", "participant_id")}};
  for (const std::string& answer : given) {
    table.columns.push_back(proportion_column(answer, "given_" + answer));
  }
  for (auto& [participant, by_answer] : counts) {
    table.rows.push_back({word(participant)});
    for (const std::string& answer : given) {
      table.rows.back().push_back(proportion({by_answer[answer], all[participant]}));
    }
  }
  return table;
}

std::optional<DecisionTask> decision_task(const BlockDesign& design) {
  if (design.decision_model.empty()) {
    return std::nullopt;
  }
  const DecisionModelRow* const row = find_decision_model(design.decision_model);
  if (row == nullptr) {
    throw core::InvalidInput{fmt::format("block '{}': there is no decision model '{}'", design.name,
                                         design.decision_model)};
  }
  const DecisionTask task{row->model, static_cast<int>(std::lround(1.0 / design.guess_rate))};
  constexpr double tolerance = 1e-6;
  if (std::abs(chance(task) - design.guess_rate) > tolerance) {
    throw core::InvalidInput{fmt::format("block '{}': {} has no guess rate of {}", design.name,
                                         row->name, design.guess_rate)};
  }
  return task;
}

namespace {
using results::AlternativeRow;
using results::AnswerRow;

struct Counts {
  Proportion correct;
  Proportion correct_of_different;
  Proportion correct_of_same;
};

bool is_of_different(const AnswerRow& answer) {
  return std::ranges::any_of(answer.alternatives, [&](const AlternativeRow& alternative) {
    const AlternativeRow& first = answer.alternatives.front();
    return alternative.stimulus != first.stimulus || alternative.axis_values != first.axis_values;
  });
}

std::string stimuli_of(const AnswerRow& answer) {
  std::set<std::string> names;
  for (const AlternativeRow& alternative : answer.alternatives) {
    names.insert(alternative.stimulus);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

void check(const BlockDesign& design) {
  if (!(design.guess_rate > 0.0 && design.guess_rate < 1.0)) {
    throw core::InvalidInput{fmt::format("block '{}': a guess rate is between 0 and 1, not {}",
                                         design.name, design.guess_rate)};
  }
}

void check(const BlockDesign& design, const AnswerRow& answer) {
  if (!answer.is_correct) {
    throw core::InvalidInput{
        fmt::format("block '{}': the answer of {} to trial {} is neither right nor wrong",
                    design.name, answer.participant_id, answer.number)};
  }
}

std::optional<DifferentRates> rates_of(const Counts& counts) {
  if (counts.correct_of_different.trials == 0 || counts.correct_of_same.trials == 0) {
    return std::nullopt;
  }
  DifferentRates rates;
  rates.hits = counts.correct_of_different;
  rates.false_alarms = {counts.correct_of_same.trials - counts.correct_of_same.successes,
                        counts.correct_of_same.trials};
  const double hit_rate = log_linear_rate(rates.hits);
  const double false_alarm_rate = log_linear_rate(rates.false_alarms);
  rates.differencing = same_different_differencing(hit_rate, false_alarm_rate);
  rates.independent = same_different_independent(hit_rate, false_alarm_rate);
  rates.differencing_interval =
      same_different_differencing_interval(rates.hits, rates.false_alarms);
  rates.independent_interval = same_different_independent_interval(rates.hits, rates.false_alarms);
  rates.criterion = yes_no_sensitivity(rates.hits, rates.false_alarms);
  return rates;
}

std::optional<DPrimeOfMean> d_prime_of_mean(const std::vector<Proportion>& correct,
                                            const DecisionTask& task) {
  const auto over = mean_share(correct);
  if (!over || !over->interval) {
    return std::nullopt;
  }
  return DPrimeOfMean{
      d_prime_of(task, over->mean),
      {d_prime_of(task, over->interval->low), d_prime_of(task, over->interval->high)}};
}

ParticipantDiscrimination participant_of(const std::string& name, const Counts& counts,
                                         const std::optional<DecisionTask>& task) {
  ParticipantDiscrimination person{name, counts.correct, {}, {}, rates_of(counts)};
  if (task) {
    person.sensitivity = sensitivity(*task, counts.correct);
  }
  return person;
}

// By their stimuli, then by participant.
using CountsOfPairs = std::map<std::string, std::map<std::string, Proportion>>;

std::vector<DiscriminationResults::Pair> pairs_of(const CountsOfPairs& counts,
                                                  const std::optional<DecisionTask>& task) {
  std::vector<DiscriminationResults::Pair> pairs;
  for (const auto& [stimuli, of_participants] : counts) {
    DiscriminationResults::Pair& pair =
        pairs.emplace_back(DiscriminationResults::Pair{stimuli, {}});
    for (const auto& [name, correct] : of_participants) {
      pair.correct.push_back(correct);
    }
    if (task) {
      pair.d_prime = d_prime_of_mean(pair.correct, *task);
    }
  }
  return pairs;
}
}  // namespace

bool are_same_presented(const std::vector<ParticipantDiscrimination>& people) {
  return std::ranges::any_of(people, [](const auto& person) { return person.rates.has_value(); });
}

std::vector<Proportion> correct_of(const std::vector<ParticipantDiscrimination>& people) {
  std::vector<Proportion> correct;
  std::ranges::transform(people, std::back_inserter(correct), &ParticipantDiscrimination::correct);
  return correct;
}

namespace {
// Of two answers the other one is right; of more the alternative that alone is what it is, or is as
// the last one, which no answer names.
std::string right_in_place_of(const AnswerRow& answer, const std::set<std::string>& given,
                              bool are_two) {
  if (are_two) {
    const auto other = std::ranges::find_if(
        given, [&](const std::string& response) { return response != answer.response; });
    return other != given.end() ? *other : "not " + answer.response;
  }
  const auto& all = answer.alternatives;
  const bool has_sample = !all.empty() && all.back().label == "X";
  const auto count_of = [&](bool is_comparison) {
    return std::ranges::count(all, is_comparison, &AlternativeRow::is_comparison);
  };
  const bool of_right = has_sample ? all.back().is_comparison : count_of(true) == 1;
  if (all.empty() || count_of(of_right) != (has_sample ? 2 : 1)) {
    return "";
  }
  return std::ranges::find(all, of_right, &AlternativeRow::is_comparison)->label;
}

RightAnswers each_by_itself(std::size_t answers) {
  RightAnswers right(answers, std::vector<bool>(answers, false));
  for (std::size_t i = 0; i < answers; ++i) {
    right[i][i] = true;
  }
  return right;
}

constexpr int fewest_draws = 999;
constexpr int most_draws = 9999;
constexpr std::uint64_t places_seed = 8;

PermutationResult tested_by_places(const NullTables& tables) {
  return permutation_tests(tables, {each_by_itself(tables.observed.size())},
                           affordable_replicates(tables.work, fewest_draws, most_draws),
                           places_seed)
      .front();
}

void test_participants(const BlockDesign& design, const std::vector<AnswerRow>& answers,
                       DiscriminationResults& results) {
  std::map<std::string, std::vector<AnswerRow>> own;
  for (const AnswerRow& answer : answers) {
    own[answer.participant_id].push_back(answer);
  }
  for (ParticipantDiscrimination& person : results.participants) {
    const auto places = places_redrawn(design, own[person.participant_id]);
    person.p = places ? tested_by_places(*places).p
                      : binomial_p_at_least(person.correct, design.guess_rate);
  }
}

void test_chance(const BlockDesign& design, const std::vector<AnswerRow>& answers,
                 DiscriminationResults& results) {
  if (const auto places = places_redrawn(design, answers)) {
    const PermutationResult tested = tested_by_places(*places);
    results.p = tested.p;
    results.p_floor = tested.as_good == 0 ? tested.p : 0.0;
    results.draws = tested.draws;
  } else {
    results.p = binomial_p_at_least(results.correct, design.guess_rate);
  }
  test_participants(design, answers, results);
}
}  // namespace

std::optional<NullTables> places_redrawn(const BlockDesign& design,
                                         const std::vector<AnswerRow>& answers) {
  constexpr double half = 0.5;
  std::set<std::string> given;
  std::vector<std::string> right;
  std::ranges::transform(answers, std::inserter(given, given.end()), &AnswerRow::response);
  const bool are_two = std::abs(design.guess_rate - half) < 1e-6;
  for (const AnswerRow& answer : answers) {
    right.push_back(answer.is_correct.value_or(false) ? answer.response
                                                      : right_in_place_of(answer, given, are_two));
    if (answer.response.empty() || right.back().empty()) {
      return std::nullopt;
    }
  }
  std::set<std::string> names = given;
  names.insert(right.begin(), right.end());
  const auto place = [&](const std::string& name) {
    return static_cast<std::size_t>(std::distance(names.begin(), names.find(name)));
  };
  const CountTable empty(names.size(), std::vector<std::int64_t>(names.size(), 0));
  std::map<std::pair<std::string, int>, CountTable> tables;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    CountTable& of =
        tables.try_emplace({answers[i].participant_id, answers[i].repetition}, empty).first->second;
    ++of[place(right[i])][place(answers[i].response)];
  }
  if (tables.empty()) {
    return std::nullopt;
  }
  std::vector<CountTable> all;
  std::ranges::transform(tables, std::back_inserter(all), [](const auto& of) { return of.second; });
  return shuffled_tables(all);
}

DiscriminationResults discrimination_results(const BlockDesign& design,
                                             const std::vector<AnswerRow>& answers) {
  check(design);
  const std::optional<DecisionTask> task = decision_task(design);
  std::map<std::string, Counts> people;
  CountsOfPairs pairs;
  DiscriminationResults results;
  results.model = find_decision_model(design.decision_model);
  for (const AnswerRow& answer : answers) {
    check(design, answer);
    Counts& counts = people[answer.participant_id];
    counts.correct.add(*answer.is_correct);
    results.correct.add(*answer.is_correct);
    if (!answer.alternatives.empty()) {
      Proportion& of_kind =
          is_of_different(answer) ? counts.correct_of_different : counts.correct_of_same;
      of_kind.add(*answer.is_correct);
      pairs[stimuli_of(answer)][answer.participant_id].add(*answer.is_correct);
    }
  }
  for (const auto& [name, counts] : people) {
    results.participants.push_back(participant_of(name, counts, task));
  }
  results.pairs = pairs_of(pairs, are_same_presented(results.participants) ? std::nullopt : task);
  if (task) {
    results.d_prime_of_mean = d_prime_of_mean(correct_of(results.participants), *task);
  }
  if (design.premise.empty() && results.correct.trials > 0) {
    test_chance(design, answers, results);
  }
  return results;
}

namespace {
const Column& d_prime_column() {
  static const Column of_d_prime = interval_column("d' (95 % CI)", "d_prime");
  return of_d_prime;
}

std::string remark_on(const Sensitivity& sensitivity) {
  if (sensitivity.is_perfect) {
    return "all correct: d' computed with half an error";
  }
  return sensitivity.is_below_chance ? "below chance: d' is 0 (were answers swapped?)" : "";
}

ReportTable participants_table(const DiscriminationResults& results) {
  ReportTable table{
      "participants",
      "Participants",
      {column("participant", "participant_id"), proportion_column("correct", "correct"),
       column("above chance", "p"), d_prime_column(), column("", "d_prime_remark")}};
  for (const ParticipantDiscrimination& person : results.participants) {
    const auto& of = person.sensitivity;
    table.rows.push_back(
        {word(person.participant_id), proportion(person.correct), probability(person.p),
         of ? interval_above_zero(of->d_prime, of->interval) : nothing(d_prime_column()),
         word(of ? remark_on(*of) : "")});
  }
  return table;
}

ReportTable all_table(const BlockDesign& design, const DiscriminationResults& results) {
  ReportTable table{"all",
                    "All participants",
                    {proportion_column("correct", "correct"), column("chance", "chance"),
                     column("above chance", "p"), column("participants", "participants"),
                     interval_column("d' of the mean (95 % CI)", "d_prime_of_mean")}};
  if (!results.participants.empty()) {
    const auto& mean = results.d_prime_of_mean;
    table.rows.push_back({pooled_proportion(correct_of(results.participants)),
                          share(design.guess_rate), probability(results.p),
                          count(static_cast<std::int64_t>(results.participants.size())),
                          mean ? interval_above_zero(mean->d_prime, mean->interval)
                               : nothing(table.columns.back())});
  }
  return table;
}

ReportTable pairs_table(const DiscriminationResults& results) {
  ReportTable table{"stimuli",
                    "Stimuli that were presented together",
                    {column("stimuli", "stimuli"), proportion_column("correct", "correct"),
                     interval_column("d' of the mean (95 % CI)", "d_prime")}};
  for (const DiscriminationResults::Pair& pair : results.pairs) {
    table.rows.push_back({word(pair.stimuli), pooled_proportion(pair.correct),
                          pair.d_prime
                              ? interval_above_zero(pair.d_prime->d_prime, pair.d_prime->interval)
                              : nothing(table.columns.back())});
  }
  return table;
}

ReportTable rates_table(const DiscriminationResults& results) {
  ReportTable table{"rates",
                    "Answers that there is a difference",
                    {column("participant", "participant_id"),
                     proportion_column("to different ones (hits)", "hits"),
                     proportion_column("to same ones (false alarms)", "false_alarms")}};
  for (const ParticipantDiscrimination& person : results.participants) {
    if (person.rates) {
      table.rows.push_back({word(person.participant_id), proportion(person.rates->hits),
                            proportion(person.rates->false_alarms)});
    }
  }
  return table;
}

ReportTable models_table(const DiscriminationResults& results) {
  ReportTable table{
      "sensitivity_by_rates",
      "d' and bias by hits and false alarms",
      {column("participant", "participant_id"),
       interval_column("d' differencing (95 % CI)", "d_prime_differencing"),
       interval_column("d' independent observations (95 % CI)", "d_prime_independent"),
       interval_column("bias c (95 % CI)", "criterion"), column("", "is_below_chance")}};
  for (const ParticipantDiscrimination& person : results.participants) {
    if (const auto& rates = person.rates) {
      table.rows.push_back(
          {word(person.participant_id),
           interval(rates->differencing.d_prime, rates->differencing_interval),
           interval(rates->independent.d_prime, rates->independent_interval),
           interval(rates->criterion.criterion, rates->criterion.criterion_interval),
           flag(rates->differencing.is_below_chance)});
    }
  }
  return table;
}

std::string remark_on_model(const BlockDesign& design, const DiscriminationResults& results) {
  if (results.model != nullptr) {
    return fmt::format(
        "d' by the decision model '{}' ({}), interval by that of the proportion; over participants "
        "that of their mean proportion and of its interval.",
        results.model->name, results.model->summary);
  }
  return are_same_presented(results.participants)
             ? "Stimuli change from trial to trial, so that participants compare the two: take d' "
               "of a differencing observer, by hits and false alarms."
             : fmt::format(
                   "There is no d': no decision model is known for {} with a chance of {:.3g}.",
                   design.task, design.guess_rate);
}

std::vector<CitingText> remarks_on(const BlockDesign& design,
                                   const DiscriminationResults& results) {
  if (results.participants.empty()) {
    return {"There are no answers."};
  }
  std::vector<CitingText> remarks{
      fmt::format(
          "Chance is {:.3g}. {} Each participant: Wilson interval.", design.guess_rate,
          results.draws > 0
              ? "Tests, one-sided: participants' answers stay as they are, and what was right is "
                "shuffled within each repetition, as the study drew it."
              : "Exact binomial tests, one-sided, as if what is right were drawn anew in every "
                "trial: what was right is not known of all trials."),
      results.participants.size() > 1
          ? "The interval of all answers is over participants, from three "
            "on, each counting the same; those "
            "of one participant take the answers as independent."
          : "The interval takes the answers as independent."};
  if (!design.premise.empty()) {
    remarks.push_back("Not tested: " + design.premise);
  }
  remarks.emplace_back(remark_on_model(design, results));
  if (results.model != nullptr && results.pairs.size() > 1) {
    remarks.emplace_back(
        "d' is of all pairs of stimuli together: of none of them, where some are told apart better "
        "than others.");
  }
  for (const ParticipantDiscrimination& person : results.participants) {
    const std::string remark = person.sensitivity ? remark_on(*person.sensitivity) : "";
    if (!remark.empty()) {
      remarks.push_back(person.participant_id + ": " + remark + ".");
    }
  }
  if (are_same_presented(results.participants)) {
    remarks.emplace_back(
        "A d' of proportions correct assumes unbiased participants, and is too small where they "
        "are not: that by rates is not.");
    remarks.emplace_back(core::citing(
        "By rates: k + 1/2 in n + 1 ({}), intervals by the variance of their z ({}); d' is 0 where "
        "there are no more hits than false alarms. Bias c above 0: \"same\" is preferred.",
        "Hautus 1995"_source, "Gourevitch & Galanter 1967"_source));
  }
  return remarks;
}

HypothesisResult tested(const BlockDesign& design, const DiscriminationResults& results,
                        const PlannedHypothesis& planned) {
  HypothesisResult result{planned, "", results.correct, design.guess_rate, {}, results.p_floor};
  result.p = results.p;
  result.test =
      !design.premise.empty()       ? design.premise
      : results.correct.trials == 0 ? "there are no answers"
      : results.draws > 0
          ? fmt::format(
                "randomisation test by {} draws of what was right, one-sided, within each "
                "participant's repetitions",
                results.draws)
          : "one-sided exact binomial test of all answers";
  return result;
}

// Where participants set their own rate of guesses, a share of right answers depends on it.
std::optional<PersonalValues> shares_right(const BlockDesign& design,
                                           const DiscriminationResults& results) {
  if (design.has_own_guess_rate) {
    return std::nullopt;
  }
  return personal_shares(
      fmt::format("share of right answers, {}, chance {:.3g}", design.task, design.guess_rate),
      results.participants,
      [](const ParticipantDiscrimination& person) { return share_of(person.correct); });
}
}  // namespace

std::shared_ptr<BlockSummary> summarise_discrimination(const BlockDesign& design,
                                                       const BlockRows& rows) {
  const DiscriminationResults results = discrimination_results(design, rows.answers);
  auto summary = std::make_shared<BlockSummary>(design);
  summary->results().tables = {all_table(design, results), participants_table(results),
                               pairs_table(results),       rates_table(results),
                               models_table(results),      answer_counts_table(rows.answers)};
  summary->results().remarks = remarks_on(design, results);
  summary->personal = shares_right(design, results);
  const auto over = mean_share(correct_of(results.participants));
  if (over && over->interval) {
    summary->main_results = {{"share of right answers", over->mean, *over->interval, results.p,
                              design.guess_rate, false, over->participants}};
  }
  for (const PlannedHypothesis& planned : design.hypotheses) {
    summary->hypotheses.push_back(tested(design, results, planned));
  }
  return summary;
}
}  // namespace tapstudy::analysis
