#pragma once
#include <string>
#include <vector>

#include "results/export/table.hpp"
namespace tapstudy::results {
// The data dictionary: a name means the same in every table and file that an export writes.
// Throws std::logic_error for a name that is not in it.
const Column& known_column(const std::string& name);
// Names are separated by spaces.
std::vector<Column> known_columns(const std::string& names);
const std::vector<Column>& all_known_columns();
}  // namespace tapstudy::results
