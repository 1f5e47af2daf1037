#include "analysis/report/study/retest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/statistics/population/test_retest.hpp"
namespace tapstudy::analysis {
namespace {
// The values of those who have one in both sessions; of a ratio their logarithms.
struct BothSessions {
  std::vector<double> first;
  std::vector<double> second;
};

BothSessions values_of_both(const PersonalValues& first, const PersonalValues& second) {
  BothSessions pair;
  for (const auto& [participant, value] : first.by_participant) {
    const auto again = second.by_participant.find(participant);
    if (again != second.by_participant.end()) {
      pair.first.push_back(first.is_ratio ? std::log(value) : value);
      pair.second.push_back(first.is_ratio ? std::log(again->second) : again->second);
    }
  }
  return pair;
}

Cell correlation_cell(const BothSessions& pair) {
  const auto correlation = intraclass_correlation({pair.first, pair.second});
  return correlation ? interval(correlation->value, correlation->interval)
                     : nothing(interval_column("", "icc"));
}

// People see the limits; how well they are known is for programs.
Cell limits_cell(const LimitsOfAgreement& found, bool is_ratio) {
  Cell low = difference_or_ratio(found.limits.low, found.low_interval, is_ratio);
  const Cell high = difference_or_ratio(found.limits.high, found.high_interval, is_ratio);
  low.text = fmt::format("{} to {}", rounded(std::get<double>(low.values.front())),
                         rounded(std::get<double>(high.values.front())));
  low.values.insert(low.values.end(), high.values.begin(), high.values.end());
  return low;
}

void add_row(const BlockSummary& first, const BlockSummary& second, ReportTable& differences,
             ReportTable& ratios) {
  const PersonalValues& of_first = *first.personal;
  const BothSessions pair = values_of_both(of_first, *second.personal);
  if (pair.first.size() < 2) {
    return;
  }
  const LimitsOfAgreement found = limits_of_agreement(pair.first, pair.second);
  (of_first.is_ratio ? ratios : differences)
      .rows.push_back(
          {word(of_first.measure), word(first.block), word(second.block),
           difference_or_ratio(found.mean, found.mean_interval, of_first.is_ratio),
           limits_cell(found, of_first.is_ratio), correlation_cell(pair),
           people_known(std::ssize(pair.first), number_in_both(of_first, *second.personal))});
}

ReportTable table_of_changes(const std::string& name, const std::string& title,
                             const Column& change) {
  return {name,
          title,
          {column("", "measure"),
           column("first", "first"),
           column("second", "second"),
           change,
           {"limits of agreement",
            {"lower_limit", "lower_limit_low", "lower_limit_high", "upper_limit", "upper_limit_low",
             "upper_limit_high"}},
           interval_column("ICC (95 % CI)", "icc"),
           people_column("participants", "participants")}};
}

CitingText how_changes_were_computed() {
  return core::citing(
      "Of participants with a value in both sessions; those beyond the levels presented have none. "
      "Between the limits of agreement 95 % of people's changes lie, if changes are normal ({}); "
      "their 95 % intervals, in the CSV file, are exact under that condition ({}). ICC: the share "
      "of the variance of single values that lies between people, ICC(A,1), which a common change "
      "lowers, too ({}). "
      "Of ratios logarithms are taken. Part of a change is the scatter of finitely many trials.",
      "Bland & Altman 1986"_source, "Carkeet 2015"_source, "McGraw & Wong 1996"_source);
}

const BlockSummary* with_values(const std::vector<std::shared_ptr<const BlockSummary>>& blocks,
                                const std::string& name) {
  const auto found =
      std::ranges::find_if(blocks, [&](const auto& block) { return block->block == name; });
  return found == blocks.end() || !(*found)->personal ? nullptr : found->get();
}
}  // namespace

std::optional<ReportSection> retest_section(
    const std::vector<std::shared_ptr<const BlockSummary>>& blocks,
    const std::vector<RepeatedBlock>& repeated) {
  ReportTable differences =
      table_of_changes("retest_differences", "Changes of participants' values",
                       interval_column("second - first (95 % CI, t)", "difference"));
  ReportTable ratios = table_of_changes("retest_ratios", "Ratios of participants' values",
                                        interval_column("second / first (95 % CI, t)", "ratio"));
  for (const RepeatedBlock& block : repeated) {
    for (std::size_t i = 0; i < block.blocks.size(); ++i) {
      const BlockSummary* const first = with_values(blocks, block.blocks[i]);
      for (std::size_t j = i + 1; j < block.blocks.size(); ++j) {
        const BlockSummary* const second = with_values(blocks, block.blocks[j]);
        if (first != nullptr && second != nullptr) {
          add_row(*first, *second, differences, ratios);
        }
      }
    }
  }
  if (differences.rows.empty() && ratios.rows.empty()) {
    return std::nullopt;
  }
  ReportSection section{"Test and retest", {differences, ratios}};
  section.name = study_sections::retest;
  section.remarks.emplace_back(how_changes_were_computed());
  return section;
}
}  // namespace tapstudy::analysis
