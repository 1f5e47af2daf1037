#include "device/loop/lateness.hpp"

#include <algorithm>
#include <cmath>
namespace tapstudy::device {
namespace {
constexpr double per_octave = 4.0;
}

void LatenessCount::add(Nanoseconds lateness) noexcept {
  const double place = lateness < 1 ? 0.0 : per_octave * std::log2(static_cast<double>(lateness));
  ++in_class_[std::min(static_cast<std::size_t>(place), classes - 1)];
  ++count_;
  worst_ = std::max(worst_, lateness);
}

void LatenessCount::add(const LatenessCount& other) noexcept {
  for (std::size_t i = 0; i < classes; ++i) {
    in_class_[i] += other.in_class_[i];
  }
  count_ += other.count_;
  worst_ = std::max(worst_, other.worst_);
}

Nanoseconds LatenessCount::quantile(double share) const noexcept {
  const auto needed = static_cast<std::int64_t>(std::ceil(share * static_cast<double>(count_)));
  std::int64_t seen = 0;
  for (std::size_t i = 0; i < classes; ++i) {
    seen += in_class_[i];
    if (seen >= needed && seen > 0) {
      const double upper = std::exp2(static_cast<double>(i + 1) / per_octave);
      return std::min(worst_, static_cast<Nanoseconds>(std::ceil(upper)));
    }
  }
  return worst_;
}
}  // namespace tapstudy::device
