#pragma once
#include <string>
#include <vector>

#include "analysis/modal/response/read_response.hpp"
namespace tapstudy::analysis {
// Both as response_files.hpp says.
bool is_universal_of_responses(const std::string& file);
// At least one.
std::vector<ReadResponse> universal_responses(const std::string& file,
                                              std::vector<std::string>& remarks);
}  // namespace tapstudy::analysis
