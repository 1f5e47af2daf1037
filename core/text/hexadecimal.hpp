#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>
namespace tapstudy::core {
// Two lower-case digits a byte.
std::string to_hex(std::span<const std::byte> bytes);
// The bytes of such a text; a digit that is none counts as 0.
std::vector<std::byte> from_hex(std::string_view hex);
}  // namespace tapstudy::core
