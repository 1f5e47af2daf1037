#pragma once
#include <ostream>
#include <vector>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
// What summaries of blocks have in common on a terminal.
void write_hypotheses_text(std::ostream& out, const std::vector<HypothesisResult>& hypotheses);
}  // namespace tapstudy::analysis
