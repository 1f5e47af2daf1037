#include "analysis/report/comparison.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

#include "analysis/statistics/independent_difference.hpp"
#include "analysis/tables/tabular_summary.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using Block = std::shared_ptr<const BlockSummary>;

const BlockSummary* find_block(const Summary& summary, const std::string& name) {
  const auto found = std::ranges::find_if(summary.blocks,
                                          [&](const Block& block) { return block->block == name; });
  return found == summary.blocks.end() ? nullptr : found->get();
}

// That of the same name; of one block and a table, which has no name, those two.
const BlockSummary* counterpart(const BlockSummary& block, const Summary& own,
                                const Summary& other) {
  const bool are_single = own.blocks.size() == 1 && other.blocks.size() == 1;
  const bool is_table = block.block.empty() || other.blocks.front()->block.empty();
  return are_single && is_table ? other.blocks.front().get() : find_block(other, block.block);
}

std::string participants_of(const NamedSummary& study) {
  const int number = study.summary->participants;
  return number == 0 ? study.name
                     : fmt::format("{} ({} participant{}, {})", study.name, number,
                                   number == 1 ? "" : "s", words_of_modes(*study.summary));
}

IntervalEstimate estimate_of(const MainResult& result) {
  return {result.estimate, result.range};
}

void add_rows(const MainResult& first, const MainResult& second, const NamedSummary& a,
              const NamedSummary& b, ReportTable& table) {
  const IntervalEstimate compared =
      first.is_ratio ? independent_ratio(estimate_of(first), estimate_of(second))
                     : independent_difference(estimate_of(first), estimate_of(second));
  table.rows.push_back(
      {word(first.name), word(participants_of(a)), interval(first.estimate, first.range)});
  table.rows.push_back(
      {word(first.name), word(participants_of(b)), interval(second.estimate, second.range)});
  table.rows.push_back({word(first.name), word(first.is_ratio ? "ratio" : "difference"),
                        interval(compared.value, compared.interval)});
}

void compare_chances(const MainResult& first, const MainResult& second, const NamedSummary& a,
                     const NamedSummary& b, std::vector<std::string>& remarks) {
  constexpr double rounding = 1e-9;
  if (first.chance && second.chance && std::abs(*first.chance - *second.chance) > rounding) {
    remarks.push_back(fmt::format(
        "Guessing gives {:.3g} in {}, {:.3g} in {}: the difference is not one of the participants "
        "alone.",
        *first.chance, a.name, *second.chance, b.name));
  }
}

// People of both studies answer more alike than different people do.
std::string remark_on_people(const NamedSummary& a, const NamedSummary& b) {
  for (const NamedSummary* const study : {&a, &b}) {
    if (study->summary->participants == 0) {
      return fmt::format(
          "Participants of {} are not known: its interval, and so that of the difference, takes "
          "all answers as independent.",
          study->name);
    }
  }
  std::vector<std::string> shared;
  std::ranges::set_intersection(a.summary->participant_ids, b.summary->participant_ids,
                                std::back_inserter(shared));
  if (shared.empty()) {
    return "The interval of the difference takes all participants for different people.";
  }
  return fmt::format(
      "{} participant{} an id in both studies ({}): if the same people took part in both, the "
      "interval of the difference does not hold, as it takes them for different people.",
      shared.size(), shared.size() == 1 ? " has" : "s have", fmt::join(shared, ", "));
}

std::shared_ptr<TabularSummary> compare_blocks(const BlockSummary& first,
                                               const BlockSummary& second, const NamedSummary& a,
                                               const NamedSummary& b) {
  BlockDesign design;
  design.name = first.block;
  design.task = first.task;
  design.question = first.question;
  auto compared = std::make_shared<TabularSummary>(design);
  ReportTable table{"side_by_side",
                    "The second study against the first: difference, or ratio",
                    {column("result", "result"), column("study", "study"),
                     interval_column("estimate (95 % CI)", "estimate")}};
  const std::vector<MainResult> others = second.main_results();
  for (const MainResult& result : first.main_results()) {
    const auto other = std::ranges::find(others, result.name, &MainResult::name);
    if (other != others.end()) {
      add_rows(result, *other, a, b, table);
      compare_chances(result, *other, a, b, compared->remarks);
    }
  }
  if (first.question != second.question) {
    compared->remarks.push_back(fmt::format("{} asked: {}", b.name, second.question));
  }
  compared->remarks.push_back(remark_on_people(a, b));
  compared->parts.push_back(std::move(table));
  return compared;
}

// "block 'x': only in A", or what is compared.
void add_block(const BlockSummary& block, const NamedSummary& first, const NamedSummary& second,
               Summary& comparison) {
  const auto leave_out = [&](const std::string& why) {
    comparison.deviations.push_back(
        fmt::format("block '{}' is not compared: {}", block.block, why));
  };
  const BlockSummary* const other = counterpart(block, *first.summary, *second.summary);
  if (other == nullptr) {
    return leave_out(second.name + " has none of that name");
  }
  if (other->task != block.task) {
    return leave_out(fmt::format("its task is {} in {}, {} in {}", block.task, first.name,
                                 other->task, second.name));
  }
  const auto& own = block.personal;
  if (own && own->is_ratio && other->personal && own->measure != other->personal->measure) {
    return leave_out(fmt::format("its result is '{}' in {}, '{}' in {}", own->measure, first.name,
                                 other->personal->measure, second.name));
  }
  const auto compared = compare_blocks(block, *other, first, second);
  if (compared->parts.front().rows.empty()) {
    return leave_out("it has no result with an interval in both");
  }
  comparison.blocks.push_back(compared);
}
}  // namespace

Summary compare(const NamedSummary& first, const NamedSummary& second) {
  Summary comparison;
  comparison.title = fmt::format("{} and {}", first.name, second.name);
  comparison.modes = first.summary->modes;
  comparison.modes.insert(second.summary->modes.begin(), second.summary->modes.end());
  comparison.participants = first.summary->participants + second.summary->participants;
  for (const Block& block : first.summary->blocks) {
    add_block(*block, first, second, comparison);
  }
  for (const Block& block : second.summary->blocks) {
    if (counterpart(*block, *second.summary, *first.summary) == nullptr) {
      comparison.deviations.push_back(
          fmt::format("block '{}' is not compared: {} has none of that "
                      "name",
                      block->block, first.name));
    }
  }
  if (comparison.blocks.empty()) {
    std::string reasons;
    for (const std::string& reason : comparison.deviations) {
      reasons += "\n  " + reason;
    }
    throw core::InvalidInput{
        fmt::format("{} and {} have nothing to compare{}", first.name, second.name, reasons)};
  }
  for (const NamedSummary* const study : {&first, &second}) {
    for (const auto& [key, value] : study->summary->provenance) {
      comparison.provenance.emplace_back(study->name + ": " + key, value);
    }
  }
  comparison.stated_methods =
      "Estimates and 95 % intervals are those of the studies' own reports. Differences, and ratios "
      "of geometric means, take the two studies' participants for different people, with intervals "
      "recovered from the estimates' own (Zou & Donner 2008), of ratios from their logarithms.";
  return comparison;
}
}  // namespace tapstudy::analysis
