#include "core/plain_text.hpp"

#include <cstddef>
#include <cstdint>
namespace tapstudy::core {
namespace {
// Bytes of a character by its first one; 0: none begins so.
std::size_t length_of(unsigned char first) {
  if (first < 0x80) {
    return 1;
  }
  if (first < 0xC2 || first > 0xF4) {
    return 0;
  }
  return first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
}

// The character of so many bytes; above all characters if a byte does not continue it.
std::uint32_t character_in(std::string_view bytes) {
  constexpr std::uint32_t none = 0x110000;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  std::uint32_t character = bytes.size() == 1 ? byte(0) : byte(0) & (0xFFU >> (bytes.size() + 1U));
  for (std::size_t i = 1; i < bytes.size(); ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) {
      return none;
    }
    character = (character << 6U) | (byte(i) & 0x3FU);
  }
  return character;
}

bool is_plain(std::uint32_t character, std::size_t bytes) {
  const bool is_control =
      (character < 0x20 && character != '\n' && character != '\r' && character != '\t') ||
      (character >= 0x7F && character < 0xA0);
  const bool is_surrogate = character >= 0xD800 && character <= 0xDFFF;
  const bool is_overlong = (bytes == 3 && character < 0x800) || (bytes == 4 && character < 0x10000);
  return !is_control && !is_surrogate && !is_overlong && character < 0x110000;
}
}  // namespace

bool is_plain_text(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = length_of(static_cast<unsigned char>(text.front()));
    if (length == 0 || length > text.size() ||
        !is_plain(character_in(text.substr(0, length)), length)) {
      return false;
    }
    text.remove_prefix(length);
  }
  return true;
}
}  // namespace tapstudy::core
