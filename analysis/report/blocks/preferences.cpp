#include "analysis/report/blocks/preferences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "analysis/report/blocks/scale_intervals.hpp"
#include "analysis/report/document/sections.hpp"
#include "analysis/report/document/wording.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/rank_tests.hpp"
#include "analysis/statistics/scaling/preference_scales.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;

Eigen::Index place_of(const BlockDesign& design, const std::string& name) {
  return std::ranges::find(design.stimuli, name, &Item::name) - design.stimuli.begin();
}

constexpr const char* tie = "tie";

struct Comparison {
  Eigen::Index preferred{};
  Eigen::Index other{};
  bool is_first{};  // the preferred one stood at position 0
  bool is_tie{};    // neither was preferred
};

Comparison comparison_of(const BlockDesign& design, const AnswerRow& answer) {
  const auto refuse = [&](const char* what) {
    throw core::InvalidInput{fmt::format("block '{}', {} in trial {}: {}", design.name,
                                         answer.participant_id, answer.number, what)};
  };
  if (answer.alternatives.size() != 2) {
    refuse("a comparison takes two alternatives");
  }
  const std::string& first = answer.alternatives[0].stimulus;
  const std::string& second = answer.alternatives[1].stimulus;
  const auto items = static_cast<Eigen::Index>(design.stimuli.size());
  if (first == second || place_of(design, first) == items || place_of(design, second) == items) {
    refuse("a comparison takes two different stimuli of the block");
  }
  const bool is_tie = design.has_ties && answer.response == tie;
  if (answer.response != first && answer.response != second && !is_tie) {
    refuse("the answer is neither of the two stimuli");
  }
  if (is_tie) {
    return {place_of(design, first), place_of(design, second), false, true};
  }
  const bool is_of_first = answer.response == first;
  return {place_of(design, answer.response), place_of(design, is_of_first ? second : first),
          is_of_first == (answer.alternatives[0].position < answer.alternatives[1].position),
          false};
}

void add(const Comparison& comparison, PairedCounts& counts) {
  if (comparison.is_tie) {
    ++counts.ties(comparison.preferred, comparison.other);
    ++counts.ties(comparison.other, comparison.preferred);
  } else {
    ++counts.wins(comparison.preferred, comparison.other);
  }
}

PairedCounts no_counts(const BlockDesign& design) {
  const auto items = static_cast<Eigen::Index>(design.stimuli.size());
  const Eigen::MatrixXi none = Eigen::MatrixXi::Zero(items, items);
  return {none, design.has_ties ? none : Eigen::MatrixXi{}};
}

// Why a judge's answers do not decide a pair; empty: they do.
std::string undecided(const PairedCounts& counts, Eigen::Index i, Eigen::Index j) {
  const int wins = counts.wins(i, j);
  if (wins != counts.wins(j, i)) {
    return "";
  }
  if (wins > 0) {
    return "a pair was preferred as often either way";
  }
  return counts.ties_of(i, j) > 0 ? "of a pair neither was ever preferred"
                                  : "not every pair was compared";
}

// Of every pair.
std::string undecided(const PairedCounts& counts) {
  if (counts.items() < 3) {
    return "circular triads take three stimuli";
  }
  std::string why;
  for (Eigen::Index i = 0; i < counts.items(); ++i) {
    for (Eigen::Index j = 0; j < i && why.empty(); ++j) {
      why = undecided(counts, i, j);
    }
  }
  return why;
}

void judge_consistency(ParticipantPreferences& person) {
  const Eigen::MatrixXi& wins = person.counts.wins;
  person.no_consistency = undecided(person.counts);
  if (person.no_consistency.empty()) {
    person.consistency =
        consistency((wins.array() > wins.transpose().array()).cast<int>().matrix());
  }
}

void add_scales(PreferenceResults& results) {
  std::vector<PairedCounts> people;
  std::ranges::transform(results.participants, std::back_inserter(people),
                         &ParticipantPreferences::counts);
  // Comparisons may not connect the items; for Thurstone ties do.
  try {
    BradleyTerry found = bradley_terry(people);
    results.bradley_terry = std::move(found.scale);
    results.nu = found.nu;
  } catch (const core::NotEstimable& error) {
    results.no_scale = error.what();
  }
  try {
    results.thurstone = thurstone_case_v(people);
  } catch (const core::NotEstimable& error) {
    results.no_scale = error.what();
  }
}
}  // namespace

Proportion preferred(const PairedCounts& counts, Eigen::Index item) {
  const std::int64_t wins = counts.wins.row(item).sum();
  return {wins, wins + counts.wins.col(item).sum()};
}

Proportion tied(const PairedCounts& counts) {
  const std::int64_t ties = counts.ties.size() == 0 ? 0 : counts.ties.sum() / 2;
  return {ties, ties + counts.wins.sum()};
}

PreferenceResults preference_results(const BlockDesign& design,
                                     const std::vector<AnswerRow>& answers) {
  PreferenceResults results;
  results.counts = no_counts(design);
  std::map<std::string, ParticipantPreferences> people;
  for (const AnswerRow& answer : answers) {
    const Comparison comparison = comparison_of(design, answer);
    ParticipantPreferences& own = people[answer.participant_id];
    if (own.participant_id.empty()) {
      own.participant_id = answer.participant_id;
      own.counts = no_counts(design);
    }
    add(comparison, own.counts);
    add(comparison, results.counts);
    own.first_position.trials += comparison.is_tie ? 0 : 1;
    own.first_position.successes += comparison.is_first ? 1 : 0;
  }
  for (auto& [name, person] : people) {
    judge_consistency(person);
    results.participants.push_back(std::move(person));
  }
  if (!results.participants.empty()) {
    add_scales(results);
  }
  return results;
}

namespace {
// How often each participant preferred the stimulus, of the pairs that it was in.
std::vector<Proportion> shares_of_people(const PreferenceResults& results, Eigen::Index item) {
  std::vector<Proportion> people;
  for (const ParticipantPreferences& person : results.participants) {
    people.push_back(preferred(person.counts, item));
  }
  return people;
}

std::vector<MainResult> shares_preferred(const BlockDesign& design,
                                         const PreferenceResults& results) {
  std::vector<MainResult> shares;
  for (std::size_t i = 0; i < design.stimuli.size(); ++i) {
    const auto over = mean_share(shares_of_people(results, static_cast<Eigen::Index>(i)));
    if (over && over->interval) {
      shares.push_back({"preferred: " + design.stimuli[i].label,
                        over->mean,
                        *over->interval,
                        {},
                        {},
                        false,
                        over->participants});
    }
  }
  return shares;
}

ReportTable scale_table(const BlockDesign& design, const PreferenceResults& results) {
  const char* const interval_words = words_of_scale_interval(results.participants.size());
  const Column bradley =
      interval_column(fmt::format("Bradley-Terry ({})", interval_words), "bradley_terry");
  const Column thurstone =
      interval_column(fmt::format("Thurstone V ({})", interval_words), "thurstone");
  ReportTable table{"scale",
                    "Scales of the stimuli, mean 0",
                    {column("stimulus", "stimulus"), proportion_column("preferred", "preferred"),
                     bradley, thurstone}};
  for (std::size_t i = 0; i < design.stimuli.size(); ++i) {
    const auto item = static_cast<Eigen::Index>(i);
    table.rows.push_back(
        {labelled(design.stimuli[i]), pooled_proportion(shares_of_people(results, item)),
         results.bradley_terry
             ? interval(results.bradley_terry->values[item], results.bradley_terry->intervals[i])
             : nothing(bradley),
         results.thurstone
             ? interval(results.thurstone->values[item], results.thurstone->intervals[i])
             : nothing(thurstone)});
  }
  return table;
}

ReportTable wins_table(const BlockDesign& design, const PreferenceResults& results) {
  ReportTable table{"preferences",
                    "How often the row's stimulus was preferred to the column's",
                    {column("preferred", "preferred")}};
  for (const Item& other : design.stimuli) {
    table.columns.push_back(column("to " + other.name, "to_" + other.name));
  }
  for (std::size_t i = 0; i < design.stimuli.size(); ++i) {
    std::vector<Cell> row{labelled(design.stimuli[i])};
    for (std::size_t j = 0; j < design.stimuli.size(); ++j) {
      row.push_back(i == j ? nothing(table.columns[j + 1])
                           : count(results.counts.wins(static_cast<Eigen::Index>(i),
                                                       static_cast<Eigen::Index>(j))));
    }
    table.rows.push_back(row);
  }
  return table;
}

// Empty where participants must choose.
ReportTable ties_table(const PreferenceResults& results) {
  ReportTable table{
      "ties",
      "Ties",
      {proportion_column("neither preferred", "tied"), column("Davidson's nu", "nu")}};
  if (results.counts.ties.size() == 0 || results.participants.empty()) {
    return table;
  }
  std::vector<Proportion> people;
  for (const ParticipantPreferences& person : results.participants) {
    people.push_back(tied(person.counts));
  }
  table.rows.push_back({pooled_proportion(people), results.bradley_terry
                                                       ? number(results.nu)
                                                       : nothing(table.columns.back())});
  return table;
}

ReportTable consistency_table(const PreferenceResults& results) {
  ReportTable table{
      "consistency",
      "Consistency of the participants",
      {column("participant", "participant_id"), column("circular triads", "circular_triads"),
       column("most possible", "most_possible"), column("zeta", "zeta"),
       column("not computed because", "not_computed_because")}};
  for (const ParticipantPreferences& person : results.participants) {
    std::vector<Cell> row{word(person.participant_id)};
    if (const auto& found = person.consistency) {
      row.insert(row.end(), {count(found->circular_triads), count(found->most_possible),
                             number(found->zeta), nothing(table.columns.back(), "")});
    } else {
      row.insert(row.end(), {nothing(table.columns[1]), nothing(table.columns[2]),
                             nothing(table.columns[3]), word(person.no_consistency)});
    }
    table.rows.push_back(row);
  }
  return table;
}

ReportTable participants_table(const BlockDesign& design, const PreferenceResults& results) {
  ReportTable table{"participants",
                    "Preferences of each participant",
                    {column("participant", "participant_id"), column("stimulus", "stimulus"),
                     proportion_column("preferred", "preferred")}};
  table.shown_in = programs_only;
  for (const ParticipantPreferences& person : results.participants) {
    for (std::size_t i = 0; i < design.stimuli.size(); ++i) {
      table.rows.push_back({word(person.participant_id), labelled(design.stimuli[i]),
                            proportion(preferred(person.counts, static_cast<Eigen::Index>(i)))});
    }
  }
  return table;
}

ReportTable position_table(const PreferenceResults& results) {
  ReportTable table{
      "position", "First position", {proportion_column("preferred the first", "first_preferred")}};
  if (!results.participants.empty()) {
    std::vector<Proportion> people;
    std::ranges::transform(results.participants, std::back_inserter(people),
                           &ParticipantPreferences::first_position);
    table.rows.push_back({pooled_proportion(people)});
  }
  return table;
}

std::vector<CitingText> remarks_on(const BlockDesign& design, const PreferenceResults& results) {
  if (results.participants.empty()) {
    return {"There are no answers."};
  }
  std::vector<CitingText> remarks;
  if (results.no_scale.empty()) {
    remarks.emplace_back(
        core::citing("Scales by maximum likelihood of all answers. Bradley-Terry ({}): logarithms "
                     "of abilities; Thurstone's Case V ({}): standard deviations of a difference.",
                     "Bradley & Terry 1952"_source, "Thurstone 1927"_source));
    remarks.push_back(remark_on_scale_interval(results.participants.size()));
  } else {
    std::string items;
    for (std::size_t i = 0; i < design.stimuli.size(); ++i) {
      items += fmt::format("{}{} {}", i == 0 ? "" : ", ", i + 1, design.stimuli[i].name);
    }
    remarks.push_back(fmt::format("No scale{}: {}. Items: {}.",
                                  results.thurstone ? " by Bradley-Terry" : "", results.no_scale,
                                  items));
  }
  if (results.counts.ties.size() != 0) {
    remarks.emplace_back(
        core::citing("Proportions are of comparisons with a preference. In Bradley-Terry a tie "
                     "between two equal stimuli is nu times as probable as either preference ({}); "
                     "Thurstone takes a tie for half a preference each way.",
                     "Davidson 1970"_source));
  }
  remarks.emplace_back(core::citing(
      "Circular triads: A preferred to B, B to C, C to A; zeta is 1 without them, 0 with as many "
      "as there can be ({}). Without a bias the first position is preferred in half of the trials.",
      "Kendall & Babington Smith 1940"_source));
  return remarks;
}

HypothesisResult tested(const BlockDesign& design, const PreferenceResults& results,
                        const PlannedHypothesis& planned) {
  constexpr double half = 0.5;
  HypothesisResult result{planned, "", {}, half, {}, 0.0};
  const auto found = std::ranges::find(design.stimuli, planned.stimulus, &Item::name);
  if (found == design.stimuli.end()) {
    throw core::InvalidInput{
        fmt::format("block '{}': hypothesis '{}' names no stimulus of the "
                    "block",
                    design.name, planned.name)};
  }
  std::vector<double> differences;
  for (const ParticipantPreferences& person : results.participants) {
    const Proportion own = preferred(person.counts, found - design.stimuli.begin());
    differences.push_back(static_cast<double>(2 * own.successes - own.trials));
  }
  const SignTest test = sign_test(differences);
  result.observed = test.above;
  if (!design.premise.empty()) {
    result.test = design.premise;
  } else if (test.above.trials == 0) {
    result.test = "no participant preferred it more or less often than in half its comparisons";
  } else {
    result.p = test.p;
    result.test =
        "exact sign test, one-sided, of participants who preferred it in more than half of its "
        "comparisons; those with half are left out";
  }
  return result;
}
}  // namespace

std::shared_ptr<BlockSummary> summarise_preferences(const BlockDesign& design,
                                                    const BlockRows& rows) {
  const PreferenceResults results = preference_results(design, rows.answers);
  auto summary = std::make_shared<BlockSummary>(design);
  summary->results().tables = {scale_table(design, results), wins_table(design, results),
                               ties_table(results),          position_table(results),
                               consistency_table(results),   participants_table(design, results)};
  summary->main_results = shares_preferred(design, results);
  summary->results().remarks = remarks_on(design, results);
  for (const PlannedHypothesis& planned : design.hypotheses) {
    summary->hypotheses.push_back(tested(design, results, planned));
  }
  return summary;
}
}  // namespace tapstudy::analysis
