#pragma once
#include <chrono>
namespace tapstudy::core {
// Lap timer: seconds since the previous call.
class Stopwatch {
 public:
  double lap_s() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_{std::chrono::steady_clock::now()};
};
}  // namespace tapstudy::core
