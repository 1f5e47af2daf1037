#include <fmt/format.h>

#include <algorithm>

#include "analysis/blocks/wording.hpp"
#include "analysis/identification/chance_tests.hpp"
#include "analysis/identification/identification_words.hpp"
#include "analysis/identification/participant_sections.hpp"
namespace tapstudy::analysis {
namespace {
Cell range_cell(const std::optional<Interval>& interval) {
  return interval ? Cell{percent_range(*interval), {interval->low, interval->high}}
                  : Cell{"–", {Value{}, Value{}}};
}

Column range_column(const std::string& heading, const std::string& key) {
  return {heading, {key + "_low", key + "_high"}};
}

Column exact_column() {
  return range_column("exact (Clopper & Pearson 1934)", "exact");
}

ReportTable estimates_table(const IdentificationSummary& summary) {
  ReportTable table{
      "accuracy_estimates",
      "Right answers over participants",
      {column("right", "right"), column("answers", "answers"), column("of all", "share"),
       column("chance", "chance"), column("above chance", "p"),
       column("mean of participants", "mean_of_participants"),
       range_column("95 % CI, beta-binomial", "beta_binomial"), range_column("95 % CI, t", "t"),
       range_column("95 % CI, bootstrap", "bootstrap"),
       column("intra-class correlation", "intraclass_correlation"),
       range_column("if answers were independent (Wilson)", "independent_wilson")}};
  std::vector<FactorResult> results{{"all answers", "", summary.accuracy, summary.matrix.chance(),
                                     summary.accuracy_over_participants}};
  results.front().p = summary.chance_p;
  results.insert(results.end(), summary.factors.begin(), summary.factors.end());
  for (const FactorResult& result : results) {
    const auto& over = result.over_participants;
    if (result.accuracy.trials == 0) {
      continue;
    }
    table.rows.push_back({word(title_of(result)),
                          {fraction(result.accuracy), {result.accuracy.trials}},
                          {percent(result.accuracy), {result.accuracy.value()}},
                          share(result.chance),
                          probability(result.p),
                          over ? share(over->mean_of_shares) : number(std::nullopt),
                          range_cell(over ? std::optional{over->interval} : std::nullopt),
                          range_cell(over ? over->t : std::nullopt),
                          range_cell(over ? over->bootstrap : std::nullopt),
                          over ? number(over->intraclass_correlation) : number(std::nullopt),
                          range_cell(wilson_interval(result.accuracy))});
  }
  return table;
}

bool has_other_answers(const IdentificationSummary& summary) {
  return summary.matrix.share_of_alternatives() < 1.0;
}

void add_remark_on_chance(const IdentificationSummary& summary, ReportSection& section) {
  if (has_other_answers(summary)) {
    section.remarks.emplace_back(
        "Some answers name no stimulus, and count as wrong. Chance is that of an observer who "
        "gives such answers as often and otherwise guesses; the exact binomial test of each "
        "participant, which assumes that every answer is a guess among the stimuli, is left out.");
    return;
  }
  section.remarks.emplace_back(
      "A participant's probability (one-sided, not adjusted for the number of participants) is "
      "exact binomial where each answer was right as often as the others, else by shuffling the "
      "answers over the trials.");
  if (const auto constant = share_of_constant_answer(summary.matrix)) {
    section.remarks.push_back(
        fmt::format("Answers were not right equally often: always giving the one that was right "
                    "most often is right in {}, not in {}.",
                    percent(*constant), percent(summary.matrix.chance())));
  }
}

ReportTable participants_table(const IdentificationSummary& summary) {
  ReportTable table{"participants_against_chance",
                    "Each participant against chance",
                    {column("participant", "participant_id"), proportion_column("right", "right"),
                     exact_column(), column("above chance", "p")}};
  for (const ParticipantAccuracy& person : summary.participants) {
    table.rows.push_back({word(person.participant_id), proportion(person.accuracy),
                          range_cell(exact_interval(person.accuracy)), probability(person.p)});
  }
  return table;
}
}  // namespace

ReportSection accuracy_section(const IdentificationSummary& summary) {
  ReportSection section{"Accuracy"};
  section.tables = {estimates_table(summary)};
  if (!has_other_answers(summary)) {
    section.tables.push_back(participants_table(summary));
  }
  if (summary.accuracy_over_participants) {
    section.remarks.emplace_back(
        "95 % intervals hold for participants of whom these are a sample: profile likelihood of a "
        "beta-binomial distribution (Williams 1975) with the quantile of t for the number of "
        "participants, which holds the mean in more than 95 % of studies where participants are "
        "few; t and the bootstrap (BCa, Efron 1987, expanded after Hesterberg 2015) over "
        "participants' shares are given beside it. Wilson's interval would hold if all answers "
        "were independent of one another.");
  }
  section.remarks.push_back("All answers against chance: " + summary.chance_test + ".");
  add_remark_on_chance(summary, section);
  return section;
}

ReportSection independent_accuracy_section(const IdentificationSummary& summary) {
  ReportSection section{"Accuracy"};
  ReportTable table{"independent_accuracy",
                    "Right answers, if all were independent",
                    {proportion_column("right (Wilson 1927)", "right"), exact_column(),
                     column("chance", "chance"), column("above chance", "p")}};
  std::vector<Cell> row{proportion(summary.accuracy), range_cell(exact_interval(summary.accuracy))};
  section.remarks.emplace_back(
      "Participants are not known: everything here takes all answers as independent, which those "
      "of one person are not.");
  if (has_other_answers(summary) || share_of_constant_answer(summary.matrix)) {
    row.push_back(nothing(table.columns[2]));
    row.push_back(nothing(table.columns[3]));
    section.remarks.emplace_back(
        has_other_answers(summary)
            ? "Some answers name no stimulus: there is no binomial test against chance."
            : "Answers were not right equally often: there is no binomial test against chance.");
  } else {
    const double chance = summary.matrix.chance();
    row.push_back(share(chance));
    row.push_back(probability(binomial_p_at_least(summary.accuracy, chance)));
    section.remarks.emplace_back("The test against chance is exact binomial, one-sided.");
  }
  table.rows.push_back(std::move(row));
  section.tables.push_back(std::move(table));
  return section;
}
}  // namespace tapstudy::analysis
