#pragma once
#include <string>
#include <vector>

#include "analysis/modal/response/read_response.hpp"
namespace tapstudy::analysis {
// Both as response_files.hpp says.
bool is_table_of_responses(const std::string& file);
// At least one.
std::vector<ReadResponse> responses_of_table(const std::string& file);
}  // namespace tapstudy::analysis
