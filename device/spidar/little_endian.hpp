#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
namespace tapstudy::device {
inline void put_u16(std::span<std::uint8_t> bytes, std::size_t at, std::uint16_t value) noexcept {
  bytes[at] = static_cast<std::uint8_t>(value & 0xFFU);
  bytes[at + 1] = static_cast<std::uint8_t>(value >> 8U);
}
inline std::uint16_t get_u16(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8U);
}
inline std::uint32_t get_u24(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return get_u16(bytes, at) | static_cast<std::uint32_t>(bytes[at + 2]) << 16U;
}
}  // namespace tapstudy::device
