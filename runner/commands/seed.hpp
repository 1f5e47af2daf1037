#pragma once
#include <cstdint>
#include <string>
namespace tapstudy::runner {
// A whole number from 0 to 2^64 - 1. Throws InvalidInput naming the option if the text is not one.
std::uint64_t seed_from(const std::string& text, const std::string& option);
}  // namespace tapstudy::runner
