#pragma once
#include <string>
namespace tapstudy::protocols {
// A whole text file of at most 4 MB. Throws InvalidInput if it cannot be read or is longer.
std::string contents_of(const std::string& file);
}  // namespace tapstudy::protocols
