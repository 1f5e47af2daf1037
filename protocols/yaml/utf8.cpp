#include "protocols/yaml/utf8.hpp"

#include <cstdint>
namespace tapstudy::protocols {
namespace {
// How many bytes follow a first byte, and the least code point that needs so many.
struct Lead {
  int following;
  std::uint32_t bits;
  std::uint32_t least;
};

Lead lead_of(unsigned char byte) {
  if (byte < 0x80U) {
    return {0, byte, 0};
  }
  if (byte >= 0xc0U && byte < 0xe0U) {
    return {1, byte & 0x1fU, 0x80U};
  }
  if (byte >= 0xe0U && byte < 0xf0U) {
    return {2, byte & 0x0fU, 0x800U};
  }
  if (byte >= 0xf0U && byte < 0xf8U) {
    return {3, byte & 0x07U, 0x10000U};
  }
  return {-1, 0, 0};
}

bool is_code_point(std::uint32_t code, const Lead& lead) {
  const bool is_surrogate = code >= 0xd800U && code <= 0xdfffU;
  return code >= lead.least && code <= 0x10ffffU && !is_surrogate;
}
}  // namespace

bool is_utf8(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const Lead lead = lead_of(static_cast<unsigned char>(text[i]));
    const auto following = static_cast<std::size_t>(lead.following);
    if (lead.following < 0 || i + following >= text.size()) {
      return false;
    }
    std::uint32_t code = lead.bits;
    for (std::size_t k = 1; k <= following; ++k) {
      const auto byte = static_cast<unsigned char>(text[i + k]);
      if ((byte & 0xc0U) != 0x80U) {
        return false;
      }
      code = (code << 6U) | (byte & 0x3fU);
    }
    if (!is_code_point(code, lead)) {
      return false;
    }
    i += 1 + following;
  }
  return true;
}
}  // namespace tapstudy::protocols
