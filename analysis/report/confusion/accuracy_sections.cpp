#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "analysis/report/confusion/chance_tests.hpp"
#include "analysis/report/confusion/confusion_sections.hpp"
#include "analysis/report/confusion/confusion_summary.hpp"
#include "analysis/report/document/wording.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/rank_tests.hpp"
namespace tapstudy::analysis {
namespace {
// Unset if a stimulus has no level, or all have the same.
std::optional<Grouping> grouped(const std::string& name, const std::vector<std::string>& levels) {
  Grouping grouping{name, {}, {}};
  for (const std::string& level : levels) {
    if (level.empty()) {
      return std::nullopt;
    }
    auto found = std::ranges::find(grouping.levels, level);
    if (found == grouping.levels.end()) {
      found = grouping.levels.insert(found, level);
    }
    grouping.level_of_stimulus.push_back(static_cast<std::size_t>(found - grouping.levels.begin()));
  }
  return grouping.levels.size() > 1 ? std::optional{grouping} : std::nullopt;
}
}  // namespace

std::vector<Grouping> groupings_of_stimuli(const IdentificationData& data) {
  std::vector<Grouping> groupings;
  const auto add = [&](const std::string& name, const auto& level_of) {
    std::vector<std::string> levels;
    std::ranges::transform(data.stimuli, std::back_inserter(levels), level_of);
    if (auto grouping = grouped(name, levels)) {
      groupings.push_back(std::move(*grouping));
    }
  };
  add("technique", [](const Item& stimulus) { return stimulus.technique; });
  if (!data.stimuli.empty()) {
    for (const auto& [factor, level] : data.stimuli.front().factors) {
      add(factor, [&key = factor](const Item& stimulus) {
        const auto found = stimulus.factors.find(key);
        return found == stimulus.factors.end() ? std::string{} : found->second;
      });
    }
  }
  return groupings;
}

std::optional<Grouping> grouping_by_repetition(const IdentificationData& data) {
  int most = 0;
  for (const IdentifyingParticipant& person : data.participants) {
    for (const IdentifiedTrial& trial : person.trials) {
      if (trial.repetition < 1) {
        return std::nullopt;
      }
      most = std::max(most, trial.repetition);
    }
  }
  constexpr int most_levels = 20;
  constexpr int parts = 10;
  Grouping grouping{"presentation", {}, {}, most > most_levels ? (most + parts - 1) / parts : 1};
  const int step = grouping.repetitions_a_level;
  for (int first = 1; first <= most; first += step) {
    grouping.levels.push_back(step == 1
                                  ? fmt::format("{}", first)
                                  : fmt::format("{}–{}", first, std::min(most, first + step - 1)));
  }
  return most > 1 ? std::optional{grouping} : std::nullopt;
}

namespace {
Cell range_cell(const std::optional<Interval>& interval) {
  return interval ? Cell{percent_range(*interval), {interval->low, interval->high}}
                  : Cell{"–", {Value{}, Value{}}};
}

Column range_column(const CitingText& heading, const std::string& key) {
  return {heading, {key + "_low", key + "_high"}};
}

Column exact_column() {
  return range_column(core::citing("exact ({})", "Clopper & Pearson 1934"_source), "exact");
}

ReportTable estimates_table(const IdentificationSummary& summary) {
  ReportTable table{
      "accuracy_estimates",
      "Right answers over participants",
      {column("right", "right"), column("answers", "answers"), column("of all", "share"),
       column("chance", "chance"), column("above chance", "p"),
       column("mean of participants", "mean_of_participants"),
       range_column("95 % CI", "over_participants"), range_column("95 % CI, t", "t"),
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
                          over ? share(over->mean) : number(std::nullopt),
                          range_cell(over ? over->interval : std::nullopt),
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
  section.remarks.push_back(
      fmt::format("A participant's probability (one-sided, not adjusted for the number of "
                  "participants) is that of the same test of that participant's answers alone, by "
                  "{} draws, so that none is below about {:.2g}.",
                  draws_of_a_participant, summary.smallest_p_of_one));
  if (has_other_answers(summary)) {
    section.remarks.emplace_back(
        "Some answers name no stimulus, and count as wrong. Chance is that of an observer who "
        "gives such answers as often and otherwise guesses.");
  } else if (const auto constant = share_of_constant_answer(summary.matrix)) {
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
  section.tables = {estimates_table(summary), participants_table(summary)};
  if (summary.accuracy_over_participants) {
    section.remarks.emplace_back(core::citing(
        "95 % intervals hold for participants of whom these are a sample, from three on, each "
        "counting the same: the score interval of their mean ({}) with the variance that they show "
        "({}) and the quantile of t; t and the bootstrap (BCa, {}, expanded after {}) over their "
        "shares are given beside it. The intra-class correlation is that of a beta-binomial "
        "distribution ({}). Wilson's interval of all answers would hold if they were independent "
        "of "
        "one another.",
        "Wilson 1927"_source, "Wedderburn 1974"_source, "Efron 1987"_source,
        "Hesterberg 2015"_source, "Williams 1975"_source));
  }
  section.remarks.push_back("All answers against chance: " + summary.chance_test + ".");
  add_remark_on_chance(summary, section);
  return section;
}

ReportSection independent_accuracy_section(const IdentificationSummary& summary) {
  ReportSection section{"Accuracy"};
  ReportTable table{"independent_accuracy",
                    "Right answers, if all were independent",
                    {proportion_column(core::citing("right ({})", "Wilson 1927"_source), "right"),
                     exact_column(), column("chance", "chance"), column("above chance", "p")}};
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

namespace {
// Long form: one line a cell.
void add_cells(const IdentificationData& data, const std::string& group, const std::string& level,
               const CountTable& counts, ReportTable& table) {
  for (std::size_t i = 0; i < counts.size(); ++i) {
    std::int64_t row = 0;
    for (const std::int64_t cell : counts[i]) {
      row += cell;
    }
    for (std::size_t j = 0; j < counts[i].size() && row > 0; ++j) {
      table.rows.push_back({word(group), word(level), labelled(data.stimuli[i]),
                            labelled(data.responses[j]), count(counts[i][j]),
                            share(static_cast<double>(counts[i][j]) / static_cast<double>(row))});
    }
  }
}

struct GroupCounts {
  std::vector<CountTable> of_level;
  std::vector<std::vector<Proportion>> right;  // [level][participant]
};

GroupCounts counted(const IdentificationData& data, const Grouping& grouping) {
  const std::size_t levels = grouping.levels.size();
  GroupCounts counts{std::vector<CountTable>(
                         levels, CountTable(data.stimuli.size(),
                                            std::vector<std::int64_t>(data.responses.size(), 0))),
                     std::vector<std::vector<Proportion>>(
                         levels, std::vector<Proportion>(data.participants.size()))};
  for (std::size_t person = 0; person < data.participants.size(); ++person) {
    for (const IdentifiedTrial& trial : data.participants[person].trials) {
      const std::size_t level = grouping.level_of(trial);
      ++counts.of_level[level][trial.stimulus][trial.response];
      counts.right[level][person].add(trial.is_right);
    }
  }
  return counts;
}

Cell mean_cell(const MeanShare& over) {
  return over.interval
             ? Cell{fmt::format("{} ({})", percent(over.mean), percent_range(*over.interval)),
                    {over.mean, over.interval->low, over.interval->high}}
             : Cell{percent(over.mean), {over.mean, Value{}, Value{}}};
}

void add_group(const IdentificationData& data, const Grouping& grouping, ReportTable& shares,
               ReportTable& cells) {
  const GroupCounts counts = counted(data, grouping);
  for (std::size_t level = 0; level < grouping.levels.size(); ++level) {
    const Proportion all = sum(counts.right[level]);
    if (all.trials == 0) {
      continue;
    }
    const auto over = mean_share(counts.right[level]);
    shares.rows.push_back({word(grouping.name), word(grouping.levels[level]), counted(all),
                           over ? mean_cell(*over) : nothing(shares.columns.back())});
    add_cells(data, grouping.name, grouping.levels[level], counts.of_level[level], cells);
  }
}
}  // namespace

ReportSection counts_section(const IdentificationData& data) {
  ReportTable shares{"group_accuracy",
                     "Right answers by what was presented",
                     {column("by", "by"),
                      column("", "level"),
                      counted_column("right", "right"),
                      {"mean over participants (95 % CI)",
                       {"mean_over_participants", "interval_low", "interval_high"}}}};
  shares.columns[1].heading = "level";
  ReportTable cells{"group_counts",
                    "Counts and shares of rows",
                    {column("by", "by"), column("level", "level"), column("presented", "stimulus"),
                     column("answered", "response"), column("count", "count"),
                     column("of its row", "row_share")}};
  cells.shown_in = programs_only;
  Grouping by_stimulus{"stimulus", {}, {}};
  for (std::size_t i = 0; i < data.stimuli.size(); ++i) {
    by_stimulus.levels.push_back(data.stimuli[i].name);
    by_stimulus.level_of_stimulus.push_back(i);
  }
  add_group(data, by_stimulus, shares, cells);
  for (const Grouping& grouping : groupings_of_stimuli(data)) {
    add_group(data, grouping, shares, cells);
  }
  if (const auto by_repetition = grouping_by_repetition(data)) {
    add_group(data, *by_repetition, shares, cells);
  }
  for (const IdentifyingParticipant& person : data.participants) {
    add_cells(data, "participant", person.id, counts_of(data, person), cells);
  }
  return {"Counts by group",
          {shares, cells},
          {},
          {"The counts of every cell by participant, stimulus, technique, level and presentation "
           "are in the table group_counts (JSON and CSV)."}};
}

namespace {
constexpr std::uint64_t contrasts_seed = 5;

struct Contrast {
  std::string group;
  std::string first;
  std::string second;
  PairedContrast result;
};

// How often a participant gives the answer that is right for each stimulus, whatever is presented.
std::vector<double> right_by_preference(const IdentificationData& data,
                                        const IdentifyingParticipant& person) {
  std::vector<double> right(data.stimuli.size(), 0.0);
  for (const IdentifiedTrial& trial : person.trials) {
    for (std::size_t i = 0; i < right.size(); ++i) {
      const bool is_right = data.stimuli[i].is_answered_by(data.responses[trial.response].name);
      right[i] += is_right ? 1.0 / static_cast<double>(person.trials.size()) : 0.0;
    }
  }
  return right;
}

// The share of right answers at a level less what the participant's preferences among the answers
// give there: 0 on average for answers that do not depend on the stimulus, whatever is preferred.
// Unset without answers.
std::optional<double> right_beyond_preference(const IdentifyingParticipant& person,
                                              const std::vector<double>& by_preference,
                                              const Grouping& grouping, std::size_t level) {
  double sum = 0.0;
  int trials = 0;
  for (const IdentifiedTrial& trial : person.trials) {
    if (grouping.level_of(trial) == level) {
      sum += (trial.is_right ? 1.0 : 0.0) - by_preference[trial.stimulus];
      ++trials;
    }
  }
  return trials > 0 ? std::optional{sum / trials} : std::nullopt;
}

// Of each participant with answers of both levels.
std::vector<double> differences(const IdentificationData& data, const Grouping& grouping,
                                std::size_t first, std::size_t second) {
  std::vector<double> found;
  for (const IdentifyingParticipant& person : data.participants) {
    const std::vector<double> by_preference = right_by_preference(data, person);
    const auto of_first = right_beyond_preference(person, by_preference, grouping, first);
    const auto of_second = right_beyond_preference(person, by_preference, grouping, second);
    if (of_first && of_second) {
      constexpr double rounding = 1e-12;
      const double difference = *of_first - *of_second;
      found.push_back(std::abs(difference) < rounding ? 0.0 : difference);
    }
  }
  return found;
}

// alike: those that no participant shows, as where there is one answer to each of two levels.
std::vector<Contrast> contrasts_of(const IdentificationData& data, const Grouping& grouping,
                                   std::vector<std::string>& alike) {
  std::vector<Contrast> contrasts;
  for (std::size_t i = 0; i < grouping.levels.size(); ++i) {
    for (std::size_t j = i + 1; j < grouping.levels.size(); ++j) {
      const std::vector<double> found = differences(data, grouping, i, j);
      if (found.size() > 1 && std::ranges::all_of(found, [](double one) { return one == 0.0; })) {
        alike.push_back(
            fmt::format("{}: {} and {}", grouping.name, grouping.levels[i], grouping.levels[j]));
      } else if (found.size() > 1) {
        contrasts.push_back({grouping.name, grouping.levels[i], grouping.levels[j],
                             paired_contrast(found, contrasts_seed)});
      }
    }
  }
  return contrasts;
}
}  // namespace

ReportSection contrasts_section(const IdentificationData& data) {
  ReportTable table{"contrasts",
                    "Differences of right answers beyond preferences, within participants",
                    {column("of", "of"), column("first", "first"), column("second", "second"),
                     interval_column("first - second (95 % CI, t)", "difference"),
                     column("participants", "participants"), column("permutation", "p"),
                     column("after Holm", "p_holm")}};
  ReportSection section{"Contrasts"};
  std::vector<std::string> alike;
  for (const Grouping& grouping : groupings_of_stimuli(data)) {
    const std::vector<Contrast> contrasts = contrasts_of(data, grouping, alike);
    std::vector<double> p;
    std::ranges::transform(contrasts, std::back_inserter(p),
                           [](const Contrast& contrast) { return contrast.result.p; });
    const std::vector<double> adjusted = holm_adjusted(p);
    for (std::size_t i = 0; i < contrasts.size(); ++i) {
      const PairedContrast& result = contrasts[i].result;
      table.rows.push_back({word(contrasts[i].group), word(contrasts[i].first),
                            word(contrasts[i].second), interval(result.mean, result.interval),
                            count(result.participants), probability(result.p),
                            probability(adjusted[i])});
    }
  }
  section.tables.push_back(table);
  if (!alike.empty()) {
    section.remarks.push_back(fmt::format(
        "Not tested, as the difference is 0 for each participant (where two levels have one answer "
        "each, it always is): {}.",
        fmt::join(alike, "; ")));
  }
  if (table.rows.empty() && alike.empty()) {
    section.remarks.emplace_back(
        "No contrasts: no technique or factor has two levels that two participants were "
        "presented.");
  }
  if (table.rows.empty()) {
    return section;
  }
  section.remarks.emplace_back(
      core::citing("Differences of a participant's shares right, each less the share that would be "
                   "right if he gave his answers as often without regard to the stimuli: who "
                   "prefers some answers is right more often where they are right. Two-sided "
                   "permutation test by changing the signs of participants' differences (all "
                   "patterns up to 16, else 9999), adjusted within a technique or factor by {}.",
                   "Holm 1979"_source));
  return section;
}
}  // namespace tapstudy::analysis
