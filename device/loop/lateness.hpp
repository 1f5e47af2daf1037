#pragma once
#include <array>
#include <cstdint>

#include "device/loop/tick_clock.hpp"
namespace tapstudy::device {
// Histogram of tick lateness with four bins per octave: any quantile is known to within 19 %,
// without storing each tick.
class LatenessCount {
 public:
  void add(Nanoseconds lateness) noexcept;
  void add(const LatenessCount& other) noexcept;
  std::int64_t count() const noexcept { return count_; }
  Nanoseconds worst() const noexcept { return worst_; }
  // Upper edge of the bin at or below which at least this fraction of the ticks lie, 0 to 1.
  Nanoseconds quantile(double share) const noexcept;

 private:
  static constexpr std::size_t classes = 160;  // to 2^40 ns
  std::array<std::int64_t, classes> in_class_{};
  std::int64_t count_{0};
  Nanoseconds worst_{0};
};
}  // namespace tapstudy::device
