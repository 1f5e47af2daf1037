#pragma once
#include <memory>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
// Points of subjective equality and just noticeable differences from comparisons on either side of
// a standard. Throws InvalidInput as equality_results does.
std::shared_ptr<BlockSummary> summarise_equality(const BlockDesign& design, const BlockRows& rows);
}  // namespace tapstudy::analysis
