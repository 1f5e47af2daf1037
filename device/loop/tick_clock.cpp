#include "device/loop/tick_clock.hpp"

#include <cerrno>
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
}  // namespace tapstudy::device
