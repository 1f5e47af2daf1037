#pragma once
#include <array>
#include <cstdint>

#include "device/loop/tick_clock.hpp"
namespace tapstudy::device {
// How late ticks were, counted in classes four to the octave: any share of them can be told to
// 19 %, without memory for each.
class LatenessCount {
 public:
  void add(Nanoseconds lateness) noexcept;
  std::int64_t count() const noexcept { return count_; }
  Nanoseconds worst() const noexcept { return worst_; }
  // The upper end of the class below which at least this share of the ticks lie, 0 to 1.
  Nanoseconds quantile(double share) const noexcept;

 private:
  static constexpr std::size_t classes = 160;  // to 2^40 ns
  std::array<std::int64_t, classes> in_class_{};
  std::int64_t count_{0};
  Nanoseconds worst_{0};
};
}  // namespace tapstudy::device
