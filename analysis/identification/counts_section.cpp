#include <fmt/format.h>

#include <algorithm>

#include "analysis/blocks/wording.hpp"
#include "analysis/identification/identification_words.hpp"
#include "analysis/identification/participant_sections.hpp"
namespace tapstudy::analysis {
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

void add_group(const IdentificationData& data, const Grouping& grouping, ReportTable& shares,
               ReportTable& cells) {
  const GroupCounts counts = counted(data, grouping);
  for (std::size_t level = 0; level < grouping.levels.size(); ++level) {
    const Proportion all = sum(counts.right[level]);
    if (all.trials == 0) {
      continue;
    }
    const auto over = beta_binomial_mean(counts.right[level]);
    shares.rows.push_back(
        {word(grouping.name), word(grouping.levels[level]), counted(all),
         over ? Cell{fmt::format("{} ({})", percent(over->mean), percent_range(over->interval)),
                     {over->mean, over->interval.low, over->interval.high}}
              : nothing(shares.columns.back())});
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
  cells.is_for_programs = true;
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
}  // namespace tapstudy::analysis
