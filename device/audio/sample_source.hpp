#pragma once
#include <span>
namespace tapstudy::device {
// What is played into the ears.
class SampleSource {
 public:
  virtual ~SampleSource() = default;
  // The next samples; full scale is from -1 to 1. On the audio thread: must not wait.
  virtual void fill(std::span<float> samples) noexcept = 0;
};
}  // namespace tapstudy::device
