#include "device/audio/ramp.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
namespace tapstudy::device {
void Ramp::apply(std::span<float> samples, Heard wanted) noexcept {
  const long step = wanted == Heard::yes ? 1 : -1;
  for (float& sample : samples) {
    way_frames_ = std::clamp(way_frames_ + step, 0L, frames_);
    const double way = static_cast<double>(way_frames_) / static_cast<double>(frames_);
    sample *= static_cast<float>(0.5 - 0.5 * std::cos(std::numbers::pi * way));
  }
}
}  // namespace tapstudy::device
