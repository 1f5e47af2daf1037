#pragma once
#include <vector>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
struct BlockPart {
  BlockDesign design;
  BlockRows rows;
};
// A block whose threshold depends on further axes, as one part for each combination of values on
// them that was presented, in ascending order, named after the block and the values: what is
// estimated of a part is at these. Any other block, and one without answers, as a whole. Visits
// and missing replies are of all parts.
// Throws InvalidInput where an answer's comparison has no value on a further axis.
std::vector<BlockPart> parts_at_further_values(const BlockDesign& design, const BlockRows& rows);
}  // namespace tapstudy::analysis
