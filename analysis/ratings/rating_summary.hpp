#pragma once
#include <memory>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
// Ratings of one presented stimulus a trial: their distribution, Friedman's test over participants,
// pairwise signed-rank tests. Throws InvalidInput as rating_results does, and for a hypothesis
// about no stimulus of the block.
std::shared_ptr<BlockSummary> summarise_ratings(const BlockDesign& design, const BlockRows& rows);
}  // namespace tapstudy::analysis
