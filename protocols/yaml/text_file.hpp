#pragma once
#include <cstddef>
#include <string>
namespace tapstudy::protocols {
// Reads a file of at most max_bytes. Throws InvalidInput if it cannot be read or is longer.
std::string contents_of(const std::string& file, std::size_t max_bytes = 4'000'000);
}  // namespace tapstudy::protocols
