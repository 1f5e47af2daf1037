#include "analysis/report/block_contrasts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "analysis/participants/paired_contrast.hpp"
#include "analysis/rank_tests/signed_rank.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::uint64_t contrasts_seed = 6;

struct Contrast {
  const BlockSummary* first;
  const BlockSummary* second;
  PairedContrast result;  // of a ratio: of natural logarithms
};

bool are_comparable(const BlockSummary& first, const BlockSummary& second) {
  return first.personal && second.personal && first.part_of == second.part_of &&
         first.personal->measure == second.personal->measure;
}

// Of those who have values of both.
std::vector<double> differences(const PersonalValues& first, const PersonalValues& second) {
  std::vector<double> found;
  for (const auto& [participant, value] : first.by_participant) {
    const auto other = second.by_participant.find(participant);
    if (other != second.by_participant.end()) {
      found.push_back(first.is_ratio ? std::log(value / other->second) : value - other->second);
    }
  }
  return found;
}

// By the measure, in the order of the blocks.
std::map<std::string, std::vector<Contrast>> contrasts_of(
    const std::vector<std::shared_ptr<const BlockSummary>>& blocks) {
  std::map<std::string, std::vector<Contrast>> contrasts;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    for (std::size_t j = i + 1; j < blocks.size(); ++j) {
      if (!are_comparable(*blocks[i], *blocks[j])) {
        continue;
      }
      const std::vector<double> found = differences(*blocks[i]->personal, *blocks[j]->personal);
      if (found.size() > 1) {
        contrasts[blocks[i]->personal->measure].push_back(
            {blocks[i].get(), blocks[j].get(), paired_contrast(found, contrasts_seed)});
      }
    }
  }
  return contrasts;
}

Cell compared(const Contrast& contrast) {
  const PairedContrast& result = contrast.result;
  if (!contrast.first->personal->is_ratio) {
    return interval(result.mean, result.interval);
  }
  const auto range =
      result.interval
          ? std::optional{Interval{std::exp(result.interval->low), std::exp(result.interval->high)}}
          : std::nullopt;
  return interval(std::exp(result.mean), range);
}

void add_rows(const std::string& measure, const std::vector<Contrast>& contrasts,
              ReportTable& table) {
  std::vector<double> p;
  std::ranges::transform(contrasts, std::back_inserter(p),
                         [](const Contrast& contrast) { return contrast.result.p; });
  const std::vector<double> adjusted = holm_adjusted(p);
  for (std::size_t i = 0; i < contrasts.size(); ++i) {
    table.rows.push_back({word(measure), word(contrasts[i].first->block),
                          word(contrasts[i].second->block), compared(contrasts[i]),
                          count(contrasts[i].result.participants),
                          probability(contrasts[i].result.p), probability(adjusted[i])});
  }
}

ReportTable empty_table(const std::string& name, const std::string& title, const Column& compared) {
  return {name,
          title,
          {column("of", "measure"), column("first", "first"), column("second", "second"), compared,
           column("participants", "participants"), column("permutation", "p"),
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
  for (const auto& [measure, contrasts] : contrasts_of(blocks)) {
    add_rows(measure, contrasts,
             contrasts.front().first->personal->is_ratio ? ratios : differences);
  }
  if (ratios.rows.empty() && differences.rows.empty()) {
    return std::nullopt;
  }
  ReportSection section{"Blocks compared", {differences, ratios}};
  section.name = "contrasts";
  section.remarks.emplace_back(
      "Of participants with a value in both blocks; ratios are geometric means. Two-sided "
      "permutation test by changing the signs of participants' differences, of logarithms for "
      "ratios (all patterns up to 16, else 9999), adjusted by Holm 1979 for the pairs of a "
      "measure.");
  if (is_order_fixed) {
    section.remarks.emplace_back(
        "All participants did the blocks in the same order: differences between blocks are "
        "confounded with practice and fatigue.");
  }
  return section;
}
}  // namespace tapstudy::analysis
