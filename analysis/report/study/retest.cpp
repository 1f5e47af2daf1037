#include "analysis/report/study/retest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "analysis/report/document/wording.hpp"
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

// What is said of two sessions.
std::string named_pair(const BlockSummary& first, const BlockSummary& second) {
  return fmt::format("{} in {} and {}", first.personal->measure, first.block, second.block);
}

Cell correlation_cell(const BothSessions& pair, const std::string& named,
                      std::vector<CitingText>& remarks) {
  const auto correlation = intraclass_correlation({pair.first, pair.second});
  if (correlation) {
    return interval(correlation->value, correlation->interval);
  }
  remarks.emplace_back(fmt::format(
      "There is no intra-class correlation of {}: {}.", named,
      do_people_differ({pair.first, pair.second})
          ? "all participants changed alike, which leaves nothing to tell how well it is known"
          : "participants' means over both sessions do not differ, so that it is not defined"));
  return nothing(interval_column("", "icc"));
}

// Whether all are at the one end of their scale, or all at the other, both times.
bool are_at_an_end(const BothSessions& pair, const std::optional<Interval>& scale) {
  const auto all_are = [&](double end) {
    const auto is_there = [end](double value) { return value == end; };
    return std::ranges::all_of(pair.first, is_there) && std::ranges::all_of(pair.second, is_there);
  };
  return scale && (all_are(scale->low) || all_are(scale->high));
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

Column limits_column() {
  return {"limits of agreement",
          {"lower_limit", "lower_limit_low", "lower_limit_high", "upper_limit", "upper_limit_low",
           "upper_limit_high"}};
}

struct RetestTables {
  ReportTable differences;
  ReportTable ratios;
  std::vector<CitingText> remarks{};  // about pairs of blocks
  std::vector<std::string> findings{};
};

void add_row(const BlockSummary& first, const BlockSummary& second, RetestTables& tables) {
  const PersonalValues& of_first = *first.personal;
  const BothSessions pair = values_of_both(of_first, *second.personal);
  const std::string named = named_pair(first, second);
  if (pair.first.size() < 2) {
    if (!pair.first.empty()) {
      tables.remarks.emplace_back(fmt::format(
          "Of {} only one participant has both values: nothing can be said of changes.", named));
    }
    return;
  }
  const LimitsOfAgreement found = limits_of_agreement(pair.first, pair.second);
  Cell limits = limits_cell(found, of_first.is_ratio);
  if (are_at_an_end(pair, of_first.scale)) {
    limits = nothing(limits_column(), "no limits");
    tables.remarks.emplace_back(
        fmt::format("There are no limits of agreement of {}: all values are at the same end of the "
                    "scale, where no change can be seen.",
                    named));
  }
  const Cell correlation = correlation_cell(pair, named, tables.remarks);
  const int in_both = number_in_both(of_first, *second.personal);
  (of_first.is_ratio ? tables.ratios : tables.differences)
      .rows.push_back({word(of_first.measure), word(first.block), word(second.block),
                       difference_or_ratio(found.mean, found.mean_interval, of_first.is_ratio),
                       limits, correlation, people_known(std::ssize(pair.first), in_both)});
  tables.findings.push_back(
      fmt::format("{}, from {} to {}: {}; ICC {}; {}", of_first.measure, first.block, second.block,
                  contrast_in_words(found.mean, found.mean_interval, of_first.is_ratio),
                  correlation.text.words, people_in_words(std::ssize(pair.first), in_both)));
}

ReportTable table_of_changes(const std::string& name, const std::string& title,
                             const Column& change) {
  return {name,
          title,
          {column("", "measure"), column("first", "first"), column("second", "second"), change,
           limits_column(), interval_column("ICC (95 % CI)", "icc"),
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

// Summaries with people's values of the block of that name: the whole, or its parts, by what their
// names add to it.
std::map<std::string, const BlockSummary*> with_values(
    const std::vector<std::shared_ptr<const BlockSummary>>& blocks, const std::string& name) {
  std::map<std::string, const BlockSummary*> found;
  for (const auto& block : blocks) {
    if (block->personal && (block->block == name || block->part_of == name)) {
      found.emplace(block->block.substr(name.size()), block.get());
    }
  }
  return found;
}

void add_rows(const std::map<std::string, const BlockSummary*>& first,
              const std::map<std::string, const BlockSummary*>& second, RetestTables& tables) {
  for (const auto& [part, summary] : first) {
    if (const auto again = second.find(part); again != second.end()) {
      add_row(*summary, *again->second, tables);
    }
  }
}
}  // namespace

std::optional<ReportSection> retest_section(
    const std::vector<std::shared_ptr<const BlockSummary>>& blocks,
    const std::vector<RepeatedBlock>& repeated) {
  RetestTables tables{
      table_of_changes("retest_differences", "Changes of participants' values",
                       interval_column("second - first (95 % CI, t)", "difference")),
      table_of_changes("retest_ratios", "Ratios of participants' values",
                       interval_column("second / first (95 % CI, t)", "ratio"))};
  for (const RepeatedBlock& block : repeated) {
    for (std::size_t i = 0; i < block.blocks.size(); ++i) {
      for (std::size_t j = i + 1; j < block.blocks.size(); ++j) {
        add_rows(with_values(blocks, block.blocks[i]), with_values(blocks, block.blocks[j]),
                 tables);
      }
    }
  }
  const bool has_rows = !tables.differences.rows.empty() || !tables.ratios.rows.empty();
  if (!has_rows && tables.remarks.empty()) {
    return std::nullopt;
  }
  ReportSection section{"Test and retest", {tables.differences, tables.ratios}};
  section.name = study_sections::retest;
  section.findings = std::move(tables.findings);
  if (has_rows) {
    section.remarks.emplace_back(how_changes_were_computed());
  }
  std::ranges::move(tables.remarks, std::back_inserter(section.remarks));
  return section;
}
}  // namespace tapstudy::analysis
