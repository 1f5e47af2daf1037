#include "core/text/hexadecimal.hpp"

#include <charconv>
namespace tapstudy::core {
std::string to_hex(std::span<const std::byte> bytes) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string hex;
  hex.reserve(2 * bytes.size());
  for (const std::byte byte : bytes) {
    hex += digits[std::to_integer<std::size_t>(byte >> 4)];
    hex += digits[std::to_integer<std::size_t>(byte & std::byte{15})];
  }
  return hex;
}

std::vector<std::byte> from_hex(std::string_view hex) {
  std::vector<std::byte> bytes(hex.size() / 2);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    unsigned value = 0;
    const char* const first = hex.data() + 2 * i;
    std::from_chars(first, first + 2, value, 16);
    bytes[i] = static_cast<std::byte>(value);
  }
  return bytes;
}
}  // namespace tapstudy::core
