#pragma once
#include <memory>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
// All pairs of a block's stimuli, of which one is preferred: the matrix of preferences, scales by
// Bradley & Terry and by Thurstone, each participant's consistency, the share of the first
// position. Throws InvalidInput as preference_results does, and for a hypothesis about no stimulus
// of the block.
std::shared_ptr<BlockSummary> summarise_preferences(const BlockDesign& design,
                                                    const BlockRows& rows);
}  // namespace tapstudy::analysis
