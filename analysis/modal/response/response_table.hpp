#pragma once
#include <string>
#include <vector>

#include "analysis/modal/response/read_response.hpp"
namespace tapstudy::analysis {
// Both as response_files.hpp says.
bool is_table_of_responses(const std::string& file);
// At least one. A last line without a line end is left out, with a remark (whole_lines).
std::vector<ReadResponse> responses_of_table(const std::string& file,
                                             std::vector<std::string>& remarks);
}  // namespace tapstudy::analysis
