#pragma once
#include <optional>
#include <vector>

#include "analysis/blocks/design.hpp"
#include "analysis/psychometric/levels.hpp"
#include "results/rows.hpp"
namespace tapstudy::analysis {
// VariedAxis::level_of the first comparison of an answered trial, to nine digits, because values of
// one stimulus differ in their last ones where they are products; unset where no comparison stood
// beside a standard. Throws InvalidInput if it has no value on the axis.
std::optional<double> comparison_level(const BlockDesign& design, const results::AnswerRow& answer);

// One answer more at this level. Levels from low to high.
void count_at(std::vector<Level>& levels, double level, bool is_success);
}  // namespace tapstudy::analysis
