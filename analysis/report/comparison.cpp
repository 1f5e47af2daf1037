#include "analysis/report/comparison.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <set>

#include "analysis/report/document/sections.hpp"
#include "analysis/report/document/wording.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/rank_tests.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::uint64_t contrasts_seed = 6;

struct Contrast {
  const BlockSummary* first;
  const BlockSummary* second;
  PairedContrast result;  // of a ratio: of natural logarithms
  int in_both{};          // who took part in both
};

bool are_comparable(const BlockSummary& first, const BlockSummary& second) {
  return first.personal && second.personal && first.part_of == second.part_of &&
         first.personal->measure == second.personal->measure;
}

// Unset where nothing is known of the participant's value.
std::optional<Interval> range_of(const PersonalValues& values, const std::string& participant) {
  const auto scaled = [&](double value) { return values.is_ratio ? std::log(value) : value; };
  if (const auto own = values.by_participant.find(participant);
      own != values.by_participant.end()) {
    return Interval{scaled(own->second), scaled(own->second)};
  }
  const auto beyond = values.beyond.find(participant);
  return beyond == values.beyond.end()
             ? std::nullopt
             : std::optional{Interval{scaled(beyond->second.low), scaled(beyond->second.high)}};
}

std::optional<PairedContrast> contrast_of(const std::vector<Interval>& differences) {
  if (differences.size() < 2) {
    return std::nullopt;
  }
  std::vector<double> exact;
  for (const Interval& range : differences) {
    if (range.low == range.high) {
      exact.push_back(range.low);
    }
  }
  return exact.size() == differences.size() ? paired_contrast(exact, contrasts_seed)
                                            : censored_contrast(differences, contrasts_seed);
}

}  // namespace

std::vector<Interval> differences_between(const PersonalValues& first,
                                          const PersonalValues& second) {
  std::vector<Interval> found;
  for (const std::string& participant : participants_of(first)) {
    const auto own = range_of(first, participant);
    const auto other = range_of(second, participant);
    if (own && other) {
      found.push_back({own->low - other->high, own->high - other->low});
    }
  }
  return found;
}

std::optional<PairedContrast> contrast_of(const PersonalValues& first,
                                          const PersonalValues& second) {
  return contrast_of(differences_between(first, second));
}

std::optional<PairedContrast> contrast_with(const PersonalValues& values, double number) {
  PersonalValues same = values;
  same.beyond.clear();
  for (const std::string& participant : participants_of(values)) {
    same.by_participant[participant] = number;
  }
  return contrast_of(values, same);
}

namespace {
// By the measure, in the order of the blocks.
std::map<std::string, std::vector<Contrast>> contrasts_of(
    const std::vector<std::shared_ptr<const BlockSummary>>& blocks) {
  std::map<std::string, std::vector<Contrast>> contrasts;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    for (std::size_t j = i + 1; j < blocks.size(); ++j) {
      if (!are_comparable(*blocks[i], *blocks[j])) {
        continue;
      }
      const PersonalValues& first = *blocks[i]->personal;
      const PersonalValues& second = *blocks[j]->personal;
      if (const auto found = contrast_of(first, second)) {
        contrasts[first.measure].push_back(
            {blocks[i].get(), blocks[j].get(), *found, number_in_both(first, second)});
      }
    }
  }
  return contrasts;
}

std::string in_words(const Contrast& one, double p_holm, bool are_several) {
  return fmt::format(
      "{} against {}: {}; {}; {}", one.first->block, one.second->block,
      contrast_in_words(one.result.mean, one.result.interval, one.first->personal->is_ratio),
      adjusted_in_words(one.result.p, p_holm, are_several),
      people_in_words(one.result.participants, one.in_both, one.result.ranges));
}

void add_rows(const std::string& measure, const std::vector<Contrast>& contrasts,
              ReportTable& table, std::vector<std::string>& findings) {
  std::vector<double> p;
  std::ranges::transform(contrasts, std::back_inserter(p),
                         [](const Contrast& contrast) { return contrast.result.p; });
  const std::vector<double> adjusted = holm_adjusted(p);
  for (std::size_t i = 0; i < contrasts.size(); ++i) {
    const Contrast& one = contrasts[i];
    table.rows.push_back(
        {word(measure), word(one.first->block), word(one.second->block),
         difference_or_ratio(one.result.mean, one.result.interval, one.first->personal->is_ratio),
         people_known(one.result.participants, one.in_both), probability(one.result.p),
         probability(adjusted[i])});
    findings.push_back((i == 0 ? measure + ": " : "") +
                       in_words(one, adjusted[i], contrasts.size() > 1));
  }
}

ReportTable empty_table(const std::string& name, const std::string& title, const Column& compared) {
  return {name,
          title,
          {column("of", "measure"),
           column("first", "first"),
           column("second", "second"),
           compared,
           {"participants", {"participants", "participants_in_both"}},
           column("permutation", "p"),
           column("after Holm", "p_holm")}};
}
}  // namespace

std::optional<ReportSection> block_contrasts(
    const std::vector<std::shared_ptr<const BlockSummary>>& blocks, bool is_order_fixed) {
  ReportTable ratios = empty_table("contrast_ratios", "Ratios within participants",
                                   interval_column("first / second (95 % CI, t)", "ratio"));
  ReportTable differences =
      empty_table("contrast_differences", "Differences within participants",
                  interval_column("first - second (95 % CI, t)", "difference"));
  std::vector<std::string> findings;
  for (const auto& [measure, contrasts] : contrasts_of(blocks)) {
    add_rows(measure, contrasts, contrasts.front().first->personal->is_ratio ? ratios : differences,
             findings);
  }
  if (ratios.rows.empty() && differences.rows.empty()) {
    return std::nullopt;
  }
  ReportSection section{"Blocks compared", {differences, ratios}};
  section.name = study_sections::contrasts;
  section.findings = std::move(findings);
  section.remarks.emplace_back(core::citing(
      "Of participants with a value in both blocks, or one that is known to lie beyond the levels "
      "presented (\"6 of 8\": of two nothing is known); ratios are geometric means. Two-sided "
      "permutation test by changing the signs of participants' differences, of logarithms for "
      "ratios (all patterns up to 16, else 9999), adjusted by {} for the pairs of a measure. Where "
      "values lie beyond the levels, the test takes the ranks of the differences, and the interval "
      "is by a normal likelihood of values and ranges; where that does not limit it, it is "
      "infinite.",
      "Holm 1979"_source));
  if (is_order_fixed) {
    section.remarks.emplace_back(
        "All participants did the blocks in the same order: differences between blocks are "
        "confounded with practice and fatigue.");
  }
  return section;
}

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
  return {result.estimate, result.range.value(),
          result.people ? std::optional{*result.people - 1.0} : std::nullopt};
}

void add_rows(const MainResult& first, const MainResult& second, const NamedSummary& a,
              const NamedSummary& b, ReportTable& table, std::vector<CitingText>& remarks) {
  table.rows.push_back(
      {word(first.name), word(participants_of(a)), interval(first.estimate, first.range)});
  table.rows.push_back(
      {word(first.name), word(participants_of(b)), interval(second.estimate, second.range)});
  if (!first.range || !second.range) {
    remarks.push_back(fmt::format(
        "{}: not compared, as all participants of one study have the same value.", first.name));
    return;
  }
  const IntervalEstimate compared =
      first.is_ratio ? independent_ratio(estimate_of(first), estimate_of(second))
                     : independent_difference(estimate_of(first), estimate_of(second));
  table.rows.push_back({word(first.name), word(first.is_ratio ? "ratio" : "difference"),
                        interval(compared.value, compared.interval)});
}

void compare_chances(const MainResult& first, const MainResult& second, const NamedSummary& a,
                     const NamedSummary& b, std::vector<CitingText>& remarks) {
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

std::shared_ptr<BlockSummary> compare_blocks(const BlockSummary& first, const BlockSummary& second,
                                             const NamedSummary& a, const NamedSummary& b) {
  BlockDesign design;
  design.name = first.block;
  design.task = first.task;
  design.question = first.question;
  auto compared = std::make_shared<BlockSummary>(design);
  ReportTable table{"side_by_side",
                    "The second study against the first: difference, or ratio",
                    {column("result", "result"), column("study", "study"),
                     interval_column("estimate (95 % CI)", "estimate")}};
  const std::vector<MainResult> others = second.main_results;
  for (const MainResult& result : first.main_results) {
    const auto other = std::ranges::find(others, result.name, &MainResult::name);
    if (other != others.end()) {
      add_rows(result, *other, a, b, table, compared->results().remarks);
      compare_chances(result, *other, a, b, compared->results().remarks);
    }
  }
  if (first.question != second.question) {
    compared->results().remarks.push_back(fmt::format("{} asked: {}", b.name, second.question));
  }
  compared->results().remarks.push_back(remark_on_people(a, b));
  compared->results().tables.push_back(std::move(table));
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
  if (compared->results().tables.front().rows.empty()) {
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
  comparison.stated_methods = core::citing(
      "Estimates and 95 % intervals are those of the studies' own reports. Differences, and ratios "
      "of geometric means, take the two studies' participants for different people, with intervals "
      "recovered from the estimates' own ({}; degrees of freedom of {}), of ratios from their "
      "logarithms.",
      "Zou & Donner 2008"_source, "Welch 1947"_source);
  return comparison;
}
}  // namespace tapstudy::analysis
