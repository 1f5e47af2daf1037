#pragma once
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
// What summaries of blocks have in common in JSON.
nlohmann::ordered_json as_json(const Proportion& proportion);
nlohmann::ordered_json as_json(const std::vector<HypothesisResult>& hypotheses);
}  // namespace tapstudy::analysis
