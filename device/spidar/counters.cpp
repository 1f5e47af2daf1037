#include "device/spidar/counters.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
namespace tapstudy::device {
std::int64_t UnwrappedCounters::shorter_way(std::uint32_t from, std::uint32_t to) const noexcept {
  const std::int64_t turn = std::int64_t{1} << bits_;
  const std::int64_t ahead = (std::int64_t{to} - std::int64_t{from}) & (turn - 1);
  return ahead < turn / 2 ? ahead : ahead - turn;
}

std::int64_t UnwrappedCounters::take(const RawCounters& raw) noexcept {
  if (!has_begun_) {
    has_begun_ = true;
    counts_ = {};
    last_ = raw;
    return 0;
  }
  std::int64_t largest = 0;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const std::int64_t step = shorter_way(last_[i], raw[i]);
    counts_[i] += step;
    largest = std::max(largest, std::abs(step));
  }
  last_ = raw;
  return largest;
}
}  // namespace tapstudy::device
