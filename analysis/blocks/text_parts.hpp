#pragma once
#include <ostream>
#include <vector>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
// Text elements shared by the block summaries.
void write_hypotheses_text(std::ostream& out, const std::vector<HypothesisResult>& hypotheses);
}  // namespace tapstudy::analysis
