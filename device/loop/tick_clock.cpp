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

void LatenessCount::add(Nanoseconds lateness) noexcept {
  const double place =
      lateness < 1 ? 0.0 : double{per_octave} * std::log2(static_cast<double>(lateness));
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

Nanoseconds LatenessCount::of_rank(std::int64_t rank) const noexcept {
  std::int64_t seen = 0;
  for (std::size_t i = 0; i < classes; ++i) {
    seen += in_class_[i];
    if (seen >= rank && seen > 0) {
      const double upper = std::exp2(static_cast<double>(i + 1) / double{per_octave});
      return std::min(worst_, static_cast<Nanoseconds>(std::ceil(upper)));
    }
  }
  return worst_;
}

Nanoseconds LatenessCount::quantile(double share) const noexcept {
  return of_rank(static_cast<std::int64_t>(std::ceil(share * static_cast<double>(count_))));
}

// How many of n ticks are later than the quantile is binomial.
LatenessCount::Interval LatenessCount::interval_of_quantile(double share) const noexcept {
  constexpr double tail = 0.025;
  const auto n = static_cast<double>(count_);
  double log_chance = n * std::log(share);  // that so many are
  double fewer = 0.0;                       // the chance that fewer are
  std::int64_t fewest = 0;
  std::int64_t most = 0;
  for (std::int64_t later = 0; later < count_ && fewer < 1.0 - tail; ++later) {
    const auto k = static_cast<double>(later);
    fewest = fewer <= tail ? later : fewest;
    most = later;
    fewer += std::exp(log_chance);
    log_chance += std::log((n - k) / (k + 1.0) * (1.0 - share) / share);
  }
  return {of_rank(count_ - most),
          fewest > 0 ? std::optional{of_rank(count_ - fewest + 1)} : std::nullopt};
}
}  // namespace tapstudy::device
