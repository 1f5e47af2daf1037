#pragma once
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
// JSON elements shared by the block summaries.
nlohmann::ordered_json as_json(const Proportion& proportion);
nlohmann::ordered_json as_json(const std::vector<HypothesisResult>& hypotheses);
}  // namespace tapstudy::analysis
