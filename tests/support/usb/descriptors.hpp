#pragma once
#include <cstdint>
#include <vector>
namespace tapstudy::testing {
using Bytes = std::vector<std::uint8_t>;

inline constexpr std::uint8_t out_endpoint = 0x02;
inline constexpr std::uint8_t in_endpoint = 0x86;

// What a device of high speed with one interface and two bulk endpoints of 512 bytes says of
// itself: its device descriptor, then its configuration.
inline Bytes descriptors_of(std::uint16_t vendor, std::uint16_t product) {
  const auto low = [](std::uint16_t word) { return static_cast<std::uint8_t>(word & 0xFFU); };
  const auto high = [](std::uint16_t word) { return static_cast<std::uint8_t>(word >> 8U); };
  const Bytes device{
      18, 1, 0, 2, 0xFF, 0, 0xFF, 64, low(vendor), high(vendor), low(product), high(product),
      0,  1, 0, 0, 0,    1};
  const Bytes configuration{9, 2, 32, 0, 1, 1, 0, 0x80, 250};
  const Bytes interface { 9, 4, 0, 0, 2, 0xFF, 0, 0, 0 };
  const Bytes out{7, 5, out_endpoint, 2, 0, 2, 0};
  const Bytes in{7, 5, in_endpoint, 2, 0, 2, 0};
  Bytes all;
  for (const Bytes& part : {device, configuration, interface, out, in}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}
}  // namespace tapstudy::testing
