#pragma once
#include <chrono>
#include <cstddef>
#include <thread>

#include "device/audio/pcm.hpp"
namespace tapstudy::device {
inline constexpr double fastest_card = 1.002;  // against this machine's clock

// Keeps a thread from spinning where a card takes whatever it is given, as ALSA's null does:
// nothing is played more than a buffer ahead of a clock that runs so many times as fast as the
// machine's.
class Pace {
 public:
  Pace(const PcmSink& sink, double speed)
      : frames_per_s_{speed * sink.rate_hz()},
        ahead_frames_{static_cast<double>(sink.buffer_frames())} {}
  void wait_after(std::size_t frames) {
    frames_ += static_cast<double>(frames);
    const std::chrono::duration<double> due{(frames_ - ahead_frames_) / frames_per_s_};
    std::this_thread::sleep_until(begun_ + due);
  }

 private:
  std::chrono::steady_clock::time_point begun_{std::chrono::steady_clock::now()};
  double frames_per_s_;
  double ahead_frames_;
  double frames_{0.0};
};
}  // namespace tapstudy::device
