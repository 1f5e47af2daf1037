#include "device/loop/tick_clock.hpp"

#include <cerrno>
#include <ctime>
namespace tapstudy::device {
namespace {
constexpr Nanoseconds per_second = 1'000'000'000;
}

Nanoseconds MonotonicClock::now() noexcept {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return time.tv_sec * per_second + time.tv_nsec;
}

Nanoseconds MonotonicClock::wait_until(Nanoseconds deadline) noexcept {
  const timespec until{deadline / per_second, deadline % per_second};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
  return now();
}
}  // namespace tapstudy::device
