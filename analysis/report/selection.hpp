#pragma once
#include <string>
#include <vector>

#include "analysis/report/summary.hpp"
namespace tapstudy::analysis {
// Leaves out of a report all blocks and sections but those named. What a report must say anyway,
// whose data these are and what was not as planned, stays.
// Throws InvalidInput for a name that is none, with those that there are.
void keep_only(Summary& summary, const std::vector<std::string>& names);
}  // namespace tapstudy::analysis
