#pragma once
#include <cstddef>
#include <string>
namespace tapstudy::protocols {
// A whole file of at most so many bytes. Throws InvalidInput if it cannot be read or is longer.
std::string contents_of(const std::string& file, std::size_t max_bytes = 4'000'000);
}  // namespace tapstudy::protocols
