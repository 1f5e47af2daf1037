#pragma once
#include <memory>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
// Magnitude estimation: geometric means of each stimulus and value, and where the values vary along
// design.axis the exponent of Stevens' power law. Throws InvalidInput as magnitude_results does.
std::shared_ptr<BlockSummary> summarise_magnitudes(const BlockDesign& design,
                                                   const BlockRows& rows);
}  // namespace tapstudy::analysis
