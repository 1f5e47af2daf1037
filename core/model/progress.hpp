#pragma once
#include <chrono>
#include <cstddef>
#include <functional>
#include <string_view>
namespace tapstudy::core {
// Called between the steps of a long computation with its current stage; may throw to cancel it.
// May be empty.
using ProgressHook = std::function<void(std::string_view stage)>;

// Called with the number of equal parts that are done, and of all parts; may throw to cancel the
// computation. May be empty.
using CountHook = std::function<void(std::size_t done, std::size_t all)>;

inline void tell_count(const CountHook& count, std::size_t done, std::size_t all) {
  if (count) {
    count(done, all);
  }
}

inline void tell(const ProgressHook& progress, std::string_view stage) {
  if (progress) {
    progress(stage);
  }
}

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
