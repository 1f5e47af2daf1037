#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/document/block_summary.hpp"
#include "analysis/report/document/sections.hpp"
namespace tapstudy::analysis {
// A block in which two groups, by their labels, were presented different stimuli. Shares of right
// answers are of the same questions only where the same answers are right, equally often.
struct DifferentStimuli {
  std::string block;
  std::string first;
  std::string second;
  bool are_same_answers_right{};
};

// What each group's participants came to in every block that more than one group did, and the
// groups against one another: group_contrast of participants' values, of logarithms for ratios;
// where some lie beyond what was presented, the test of gehan_scores. Adjusted by Holm 1979 for all
// contrasts of a measure. Unset where no block has values of two groups.
std::optional<ReportSection> groups_section(
    const std::vector<std::shared_ptr<const BlockSummary>>& blocks,
    const std::vector<ParticipantGroup>& groups,
    const std::vector<DifferentStimuli>& different = {});

// The same contrast of two groups, of those in `groups`, that was declared before the study.
HypothesisResult compare_groups(const PlannedComparison& planned, const BlockSummary& block,
                                const std::vector<ParticipantGroup>& groups);
}  // namespace tapstudy::analysis
