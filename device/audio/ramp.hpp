#pragma once
#include <cmath>
#include <span>
namespace tapstudy::device {
enum class Heard { yes, no };

// A gain that goes from 0 to 1 and back along half a period of a cosine, without a step or a kink;
// turned round on its way it goes back from where it is.
class Ramp {
 public:
  Ramp(double duration_s, double rate_hz) : frames_{std::lround(duration_s * rate_hz)} {}
  void apply(std::span<float> samples, Heard wanted) noexcept;
  void restart() noexcept { way_frames_ = 0; }
  bool is_silent() const noexcept { return way_frames_ == 0; }

 private:
  long frames_;
  long way_frames_{0};  // 0: silent, frames_: full
};
}  // namespace tapstudy::device
