#pragma once
#include <memory>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
// Discrimination of stimuli without a procedure (odd one out, ABX, same-different): proportions
// correct against design.guess_rate, d' by design.decision_model, and where some trials hold no
// difference the rates of answering that there is one. Throws InvalidInput as
// discrimination_results does.
std::shared_ptr<BlockSummary> summarise_discrimination(const BlockDesign& design,
                                                       const BlockRows& rows);
}  // namespace tapstudy::analysis
