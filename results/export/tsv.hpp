#pragma once
#include <string>

#include "results/export/table.hpp"
namespace tapstudy::results {
// What stands for a missing value in tab-separated files of the Brain Imaging Data Structure.
inline constexpr const char* missing_in_tsv = "n/a";
// A line with its end. Tabs and line ends in texts become spaces, since the format cannot hold
// them; an empty text is missing. Reals have the fewest digits that give the same double again.
std::string tsv_line(const Row& row);
}  // namespace tapstudy::results
