#pragma once
#include <cmath>
#include <optional>

#include "core/haptics/haptic_state.hpp"
namespace tapstudy::device {
// The velocity of a hand whose device measures only its position: finite differences, which the
// quantisation of encoders dominates, through a low pass of first order with this time constant.
class VelocityEstimate {
 public:
  static constexpr double time_constant_s = 3e-3;
  // After a pause the path is unknown: the next velocity is zero.
  void forget() noexcept {
    last_m_.reset();
    velocity_m_s_.setZero();
  }
  // elapsed_s: since the position before, above zero.
  core::Vec3 take(const core::Vec3& position_m, double elapsed_s) noexcept {
    if (last_m_) {
      const core::Vec3 difference_m_s = (position_m - *last_m_) / elapsed_s;
      const double share = 1.0 - std::exp(-elapsed_s / time_constant_s);
      velocity_m_s_ += share * (difference_m_s - velocity_m_s_);
    }
    last_m_ = position_m;
    return velocity_m_s_;
  }
  const core::Vec3& velocity_m_s() const noexcept { return velocity_m_s_; }

 private:
  std::optional<core::Vec3> last_m_;
  core::Vec3 velocity_m_s_{core::Vec3::Zero()};
};
}  // namespace tapstudy::device
