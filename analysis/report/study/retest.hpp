#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/document/block_summary.hpp"
#include "analysis/report/document/sections.hpp"
namespace tapstudy::analysis {
// A block that the same participants do in several sessions, each under a name of its own, in the
// order of the sessions.
struct RepeatedBlock {
  std::string name;
  std::vector<std::string> blocks;
};

// What participants' values in one session say of those in a later one: the mean change, the limits
// of agreement and the intra-class correlation (limits_of_agreement, intraclass_correlation), of
// logarithms for ratios; of a block with parts those of each part. A remark says what cannot be
// known of a pair of sessions, and why. Unset where nobody has values in two sessions.
std::optional<ReportSection> retest_section(
    const std::vector<std::shared_ptr<const BlockSummary>>& blocks,
    const std::vector<RepeatedBlock>& repeated);
}  // namespace tapstudy::analysis
