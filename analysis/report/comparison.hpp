#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/document/block_summary.hpp"
#include "analysis/report/document/sections.hpp"
#include "analysis/report/summary.hpp"
#include "analysis/statistics/population/means.hpp"
namespace tapstudy::analysis {
// Each participant's difference between two blocks of one measure, of ratios their logarithms: a
// range where one of both lies beyond what was presented. Whoever has nothing in one has none.
std::vector<Interval> differences_between(const PersonalValues& first,
                                          const PersonalValues& second);

// Two blocks of one measure, within participants; of ratios their logarithms. Whoever is known to
// lie beyond what was presented takes part (censored_contrast). nullopt: fewer than two people.
std::optional<PairedContrast> contrast_of(const PersonalValues& first,
                                          const PersonalValues& second);
// The same of a block's values and one number.
std::optional<PairedContrast> contrast_with(const PersonalValues& values, double number);

// Blocks of one measure against one another, within participants: the mean difference or the
// geometric mean ratio, its 95 % interval by t, and the permutation test by signs
// (paired_contrast), adjusted by Holm 1979 for all pairs of a measure. Parts of a block are
// compared with other parts of the same one. is_order_fixed: all participants did the blocks in the
// same order. Unset where no two blocks have values of two participants in common.
std::optional<ReportSection> block_contrasts(
    const std::vector<std::shared_ptr<const BlockSummary>>& blocks, bool is_order_fixed);

struct NamedSummary {
  std::string name;
  const Summary* summary{};
};
// Two studies side by side: the main results of each block that both have, and their difference,
// second less first, with its interval. Their participants are taken for different people. Blocks
// that cannot be compared are named. Throws InvalidInput if there is nothing to compare.
Summary compare(const NamedSummary& first, const NamedSummary& second);
}  // namespace tapstudy::analysis
