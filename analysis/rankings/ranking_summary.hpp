#pragma once
#include <memory>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
// Rankings of all stimuli: mean ranks with Kendall's W and Friedman's test over participants, and
// worths by Plackett and Luce. Throws InvalidInput as ranking_results does.
std::shared_ptr<BlockSummary> summarise_rankings(const BlockDesign& design, const BlockRows& rows);
}  // namespace tapstudy::analysis
