#pragma once
#include <ostream>
#include <string>

#include "results/export/table.hpp"
namespace tapstudy::results {
// What stands for a missing value, and for a number that is not one: R and pandas read it as such.
inline constexpr const char* missing_in_csv = "NA";

// Writes a table as CSV (RFC 4180, lines ended by LF, UTF-8), names of columns first. Text is
// quoted where it holds a comma, a quote, a line end or a tab, begins or ends with a space, or is
// empty; so that no spreadsheet runs it, it is guarded (core/text/spreadsheet_cell.hpp). Reals have
// the fewest digits that give the same double again.
void write_csv(std::ostream& out, const Table& table);

// What stands for a missing value in tab-separated files of the Brain Imaging Data Structure.
inline constexpr const char* missing_in_tsv = "n/a";
// A line with its end. Tabs and line ends in texts become spaces, since the format cannot hold
// them; an empty text is missing. Reals have the fewest digits that give the same double again.
std::string tsv_line(const Row& row);
}  // namespace tapstudy::results
