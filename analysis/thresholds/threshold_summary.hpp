#pragma once
#include <memory>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
// A comparison differs from a standard along design.axis, by a level that a procedure chose: each
// participant's psychometric function and threshold, and their mean. Throws InvalidInput as
// participant_thresholds does.
std::shared_ptr<BlockSummary> summarise_thresholds(const BlockDesign& design,
                                                   const BlockRows& rows);
}  // namespace tapstudy::analysis
