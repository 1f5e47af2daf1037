#include "analysis/report/study/groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "analysis/report/document/wording.hpp"
#include "analysis/statistics/population/independent_groups.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "analysis/statistics/rank_tests.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::uint64_t groups_seed = 7;

// The values of one group in a block; of a ratio their logarithms.
struct GroupValues {
  const ParticipantGroup* group{};
  std::vector<double> known;
  std::vector<Interval> all;  // with those beyond what was presented
  int took_part{};
};

GroupValues values_of(const ParticipantGroup& group, const PersonalValues& values) {
  GroupValues found{&group, {}, {}, 0};
  const auto scaled = [&](double value) { return values.is_ratio ? std::log(value) : value; };
  for (const std::string& participant : group.participants) {
    const auto own = values.by_participant.find(participant);
    const auto beyond = values.beyond.find(participant);
    if (own != values.by_participant.end()) {
      found.known.push_back(scaled(own->second));
      found.all.push_back({found.known.back(), found.known.back()});
    } else if (beyond != values.beyond.end()) {
      found.all.push_back({scaled(beyond->second.low), scaled(beyond->second.high)});
    }
    const bool took_part = values.participants.empty()
                               ? own != values.by_participant.end() || beyond != values.beyond.end()
                               : values.participants.contains(participant);
    found.took_part += took_part ? 1 : 0;
  }
  return found;
}

// Those of which anybody has a value.
std::vector<GroupValues> groups_in(const BlockSummary& block,
                                   const std::vector<ParticipantGroup>& groups) {
  std::vector<GroupValues> found;
  for (const ParticipantGroup& group : groups) {
    GroupValues values = values_of(group, *block.personal);
    if (!values.all.empty()) {
      found.push_back(std::move(values));
    }
  }
  return found;
}

struct Contrast {
  const BlockSummary* block;
  GroupValues first;
  GroupValues second;
  GroupContrast result;  // without a difference where values lie beyond what was presented
};

Contrast contrast_of(const BlockSummary& block, const GroupValues& first,
                     const GroupValues& second) {
  Contrast contrast{&block, first, second, {}};
  if (first.known.size() == first.all.size() && second.known.size() == second.all.size()) {
    contrast.result = group_contrast(first.known, second.known, groups_seed);
    return contrast;
  }
  const GroupScores scores = gehan_scores(first.all, second.all);
  contrast.result = {std::numeric_limits<double>::quiet_NaN(), std::nullopt,
                     group_permutation_test(scores.first, scores.second, groups_seed)};
  return contrast;
}

Cell people_in(const GroupValues& values) {
  return people_known(std::ssize(values.all), values.took_part);
}

// The mean of those whose value is known, with the standard deviation; "–" where one is not.
std::vector<Cell> mean_cells(const GroupValues& values, bool is_ratio) {
  if (values.known.size() < values.all.size()) {
    return {number(std::nullopt), number(std::nullopt)};
  }
  const MeanAndSpread of = mean_and_spread(values.known);
  const bool has_spread = values.known.size() > 1;
  const double spread = is_ratio ? std::exp(of.standard_deviation) : of.standard_deviation;
  return {number(is_ratio ? std::exp(of.mean) : of.mean),
          number(has_spread ? std::optional{spread} : std::nullopt)};
}

std::string in_words(const GroupValues& values) {
  const std::ptrdiff_t beyond = std::ssize(values.all) - std::ssize(values.known);
  return fmt::format("{} ({})", values.group->label,
                     people_in_words(std::ssize(values.all), values.took_part, beyond));
}

std::string in_words(const Contrast& one, double p_holm, bool are_several) {
  return fmt::format(
      "{}, {} against {}: {}; {}", one.block->block, in_words(one.first), in_words(one.second),
      contrast_in_words(one.result.difference, one.result.interval, one.block->personal->is_ratio),
      adjusted_in_words(one.result.test.p, p_holm, are_several));
}

void add_rows(const std::string& measure, const std::vector<Contrast>& contrasts,
              ReportTable& table, std::vector<std::string>& findings) {
  std::vector<double> p;
  std::ranges::transform(contrasts, std::back_inserter(p),
                         [](const Contrast& contrast) { return contrast.result.test.p; });
  const std::vector<double> adjusted = holm_adjusted(p);
  for (std::size_t i = 0; i < contrasts.size(); ++i) {
    const Contrast& one = contrasts[i];
    table.rows.push_back({word(measure), word(one.block->block), word(one.first.group->label),
                          word(one.second.group->label),
                          difference_or_ratio(one.result.difference, one.result.interval,
                                              one.block->personal->is_ratio),
                          people_in(one.first), people_in(one.second), probability(p[i]),
                          probability(adjusted[i])});
    findings.push_back((i == 0 ? measure + ": " : "") +
                       in_words(one, adjusted[i], contrasts.size() > 1));
  }
}

ReportTable empty_table(const std::string& name, const std::string& title, const Column& compared) {
  return {name,
          title,
          {column("of", "measure"), column("block", "block"), column("first", "first"),
           column("second", "second"), compared,
           people_column("participants, first", "participants_first"),
           people_column("second", "participants_second"), column("permutation", "p"),
           column("after Holm", "p_holm")}};
}

CitingText how_it_was_computed() {
  return core::citing(
      "Of different people: participants' values, each counting the same; of ratios geometric "
      "means and standard deviations. Differences have {}'s interval, ratios that of the "
      "logarithms. "
      "Two-sided permutation test: participants change groups, by Welch's t (all assignments up to "
      "20000, else 9999), adjusted by {} for all contrasts of a measure. Where participants lie "
      "beyond the levels presented no mean is given, and the test takes how many of all certainly "
      "lie below each, less how many above ({}).",
      "Welch 1947"_source, "Holm 1979"_source, "Gehan 1965"_source);
}

using Contrasts = std::map<std::string, std::vector<Contrast>>;  // by measure

bool are_comparable(const BlockSummary& block, const GroupValues& first, const GroupValues& second,
                    const std::vector<DifferentStimuli>& different) {
  return std::ranges::none_of(different, [&](const DifferentStimuli& of) {
    return !of.are_same_answers_right && of.block == block.block &&
           of.first == first.group->label && of.second == second.group->label;
  });
}

std::string in_words(const DifferentStimuli& of) {
  return fmt::format("In '{}', {} and {} were presented different stimuli: {}.", of.block, of.first,
                     of.second,
                     of.are_same_answers_right
                         ? "their difference is that of the groups and of the stimuli together"
                         : "as other answers are right for these, their values are not compared");
}

// Of each two groups of more than one participant.
void add_contrasts(const BlockSummary& block, const std::vector<GroupValues>& values,
                   const std::vector<DifferentStimuli>& different, Contrasts& contrasts) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t j = i + 1; j < values.size(); ++j) {
      if (values[i].all.size() > 1 && values[j].all.size() > 1 &&
          are_comparable(block, values[i], values[j], different)) {
        contrasts[block.personal->measure].push_back(contrast_of(block, values[i], values[j]));
      }
    }
  }
}

void add_means(const BlockSummary& block, const std::vector<GroupValues>& values,
               ReportTable& means) {
  for (const GroupValues& group : values) {
    const std::vector<Cell> mean = mean_cells(group, block.personal->is_ratio);
    means.rows.push_back({word(block.block), word(block.personal->measure),
                          word(group.group->label), people_in(group), mean[0], mean[1]});
  }
}
}  // namespace

HypothesisResult compare_groups(const PlannedComparison& planned, const BlockSummary& block,
                                const std::vector<ParticipantGroup>& groups) {
  std::vector<GroupValues> values;
  for (const ParticipantGroup& group : groups) {
    if (block.personal && std::ranges::find(planned.groups, group.label) != planned.groups.end()) {
      values.push_back(values_of(group, *block.personal));
    }
  }
  const bool are_enough =
      values.size() == 2 &&
      std::ranges::all_of(values, [](const GroupValues& one) { return one.all.size() > 1; });
  if (!are_enough) {
    return {planned.hypothesis, "fewer than two participants of a group have values", {}, 0.0, {}};
  }
  const GroupContrast result = contrast_of(block, values[0], values[1]).result;
  return {planned.hypothesis,
          fmt::format("permutation test of participants between groups, two-sided; {} against {}",
                      in_words(values[0]), in_words(values[1])),
          {},
          0.0,
          result.test.p,
          0.0,
          {},
          contrast_in_words(result.difference, result.interval, block.personal->is_ratio)};
}

std::optional<ReportSection> groups_section(
    const std::vector<std::shared_ptr<const BlockSummary>>& blocks,
    const std::vector<ParticipantGroup>& groups, const std::vector<DifferentStimuli>& different) {
  ReportTable means{"groups",
                    "Each group in the blocks that several did",
                    {column("block", "block"), column("measure", "measure"),
                     column("group", "group"), people_column("participants", "participants"),
                     column("mean", "mean"), column("SD", "standard_deviation")}};
  Contrasts contrasts;
  for (const auto& block : blocks) {
    const auto values = block->personal ? groups_in(*block, groups) : std::vector<GroupValues>{};
    if (values.size() > 1) {
      add_means(*block, values, means);
      add_contrasts(*block, values, different, contrasts);
    }
  }
  if (means.rows.empty()) {
    return std::nullopt;
  }
  ReportTable differences = empty_table("group_differences", "Differences between groups",
                                        interval_column("first - second (95 % CI)", "difference"));
  ReportTable ratios = empty_table("group_ratios", "Ratios between groups",
                                   interval_column("first / second (95 % CI)", "ratio"));
  std::vector<std::string> findings;
  for (const auto& [measure, found] : contrasts) {
    add_rows(measure, found, found.front().block->personal->is_ratio ? ratios : differences,
             findings);
  }
  ReportSection section{"Groups compared", {means, differences, ratios}};
  section.name = study_sections::groups;
  section.findings = std::move(findings);
  section.remarks.emplace_back(how_it_was_computed());
  for (const DifferentStimuli& of : different) {
    section.remarks.emplace_back(in_words(of));
  }
  return section;
}
}  // namespace tapstudy::analysis
