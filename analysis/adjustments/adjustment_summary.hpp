#pragma once
#include <memory>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
// Settings of the method of adjustment: the point of subjective equality, constant error, standard
// deviation, and runs from below against runs from above, of each participant and over
// participants. Throws InvalidInput as adjustment_results does.
std::shared_ptr<BlockSummary> summarise_adjustments(const BlockDesign& design,
                                                    const BlockRows& rows);
}  // namespace tapstudy::analysis
