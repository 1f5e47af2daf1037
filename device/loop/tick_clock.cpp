#include "device/loop/tick_clock.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <ctime>
namespace tapstudy::device {
namespace {
constexpr Nanoseconds per_second = 1'000'000'000;

Nanoseconds time_of(clockid_t clock) noexcept {
  timespec time{};
  clock_gettime(clock, &time);
  return time.tv_sec * per_second + time.tv_nsec;
}
}  // namespace

Nanoseconds MonotonicClock::now() noexcept {
  return time_of(CLOCK_MONOTONIC);
}

// CLOCK_BOOTTIME counts on while the machine is suspended, CLOCK_MONOTONIC does not.
Nanoseconds MonotonicClock::suspended() noexcept {
  const Nanoseconds monotonic = time_of(CLOCK_MONOTONIC);
  return time_of(CLOCK_BOOTTIME) - monotonic;
}

Nanoseconds MonotonicClock::wait_until(Nanoseconds deadline) noexcept {
  const timespec until{deadline / per_second, deadline % per_second};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
  return now();
}

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
