#pragma once
#include <span>
namespace tapstudy::device {
// What is played: noise for the ears, or the vibration of an actuator.
class SampleSource {
 public:
  virtual ~SampleSource() = default;
  // The next samples; full scale is from -1 to 1. On the audio thread: must not wait.
  virtual void fill(std::span<float> samples) noexcept = 0;
};
}  // namespace tapstudy::device
