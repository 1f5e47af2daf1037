#include <fmt/format.h>

#include <algorithm>

#include "analysis/blocks/wording.hpp"
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

ReportTable estimates_table(const IdentificationSummary& summary) {
  ReportTable table{
      "accuracy_estimates",
      "Right answers over participants",
      {column("right", "right"), column("answers", "answers"), column("of all", "share"),
       column("chance", "chance"), column("mean of participants", "mean_of_participants"),
       range_column("95 % CI, beta-binomial", "beta_binomial"), range_column("95 % CI, t", "t"),
       range_column("95 % CI, bootstrap", "bootstrap"),
       column("intra-class correlation", "intraclass_correlation"),
       range_column("were answers independent (Wilson)", "independent_wilson"),
       column("above chance", "p")}};
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
                          over ? share(over->mean_of_shares) : number(std::nullopt),
                          range_cell(over ? std::optional{over->interval} : std::nullopt),
                          range_cell(over ? over->t : std::nullopt),
                          range_cell(over ? over->bootstrap : std::nullopt),
                          over ? number(over->intraclass_correlation) : number(std::nullopt),
                          range_cell(wilson_interval(result.accuracy)),
                          probability(result.p)});
  }
  return table;
}

ReportTable participants_table(const IdentificationSummary& summary) {
  ReportTable table{"participants_against_chance",
                    "Each participant against chance",
                    {column("participant", "participant_id"), proportion_column("right", "right"),
                     column("exact binomial", "p")}};
  for (const ParticipantAccuracy& person : summary.participants) {
    table.rows.push_back(
        {word(person.participant_id), proportion(person.accuracy),
         probability(binomial_p_at_least(person.accuracy, summary.matrix.chance()))});
  }
  return table;
}
}  // namespace

ReportSection accuracy_section(const IdentificationSummary& summary) {
  ReportSection section{"Accuracy"};
  section.tables = {estimates_table(summary), participants_table(summary)};
  if (summary.accuracy_over_participants) {
    section.remarks.emplace_back(
        "95 % intervals hold for participants of whom these are a sample: profile likelihood of a "
        "beta-binomial distribution (Williams 1975) with the quantile of t for the number of "
        "participants; t and the bootstrap (BCa, Efron 1987) over participants' shares are given "
        "beside it. Wilson's interval would hold if all answers were independent of one another.");
  }
  section.remarks.push_back("All answers against chance: " + summary.chance_test + ".");
  section.remarks.emplace_back(
      "A participant's exact binomial probability supposes that without any feeling each answer "
      "is right by the chance given, one-sided, not adjusted for the number of participants.");
  return section;
}
}  // namespace tapstudy::analysis
