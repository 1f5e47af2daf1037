#pragma once
#include <chrono>
namespace tapstudy::core {
// Lap timer: seconds since the previous call, and since the first.
class Stopwatch {
 public:
  double elapsed_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - first_).count();
  }
  double lap_s() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point first_{std::chrono::steady_clock::now()};
  std::chrono::steady_clock::time_point last_{first_};
};
}  // namespace tapstudy::core
