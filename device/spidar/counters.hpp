#pragma once
#include <array>
#include <cstdint>

#include "device/spidar/geometry.hpp"
namespace tapstudy::device {
using RawCounters = std::array<std::uint32_t, strings>;
using Counts = std::array<std::int64_t, strings>;

// Unwraps free-running encoder counters of the given width to 64 bits: between two readings the
// shorter way round is assumed.
class UnwrappedCounters {
 public:
  explicit UnwrappedCounters(int bits) noexcept : bits_{bits} {}
  // The first reading defines zero. Returns the largest step since the last one.
  std::int64_t take(const RawCounters& raw) noexcept;
  const Counts& counts() const noexcept { return counts_; }
  void forget() noexcept { has_begun_ = false; }

 private:
  std::int64_t shorter_way(std::uint32_t from, std::uint32_t to) const noexcept;
  int bits_;
  bool has_begun_{false};
  RawCounters last_{};
  Counts counts_{};
};
}  // namespace tapstudy::device
