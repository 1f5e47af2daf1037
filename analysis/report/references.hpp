#pragma once
#include <string>
#include <string_view>
#include <vector>
namespace tapstudy::analysis {
// The full references of the sources that a report names as "Author year", by author.
std::vector<std::string> references_in(std::string_view text);
}  // namespace tapstudy::analysis
