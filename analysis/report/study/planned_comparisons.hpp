#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "analysis/report/document/block_summary.hpp"
namespace tapstudy::analysis {
// Tests the declared interactions, equivalences and claims about thresholds and groups, each among
// the hypotheses of its block, over participants who have a value in every cell compared: their
// share of right answers or mean rating of a stimulus; of whole blocks what these measure of a
// participant, of ratios the logarithm. answers: of the blocks that have such hypotheses, by name.
void add_planned_comparisons(const StudyDesign& design,
                             const std::map<std::string, std::vector<results::AnswerRow>>& answers,
                             const std::vector<std::shared_ptr<BlockSummary>>& blocks);
}  // namespace tapstudy::analysis
