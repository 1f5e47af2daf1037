#include "device/remote/velocity_check.hpp"

#include <algorithm>
namespace tapstudy::device {
using core::TickFault;
namespace {
constexpr double window_length_s = 0.05;
constexpr double noticeable_m = 0.002;
constexpr double tolerance = 0.5;
constexpr int max_disagreements = 20;
}  // namespace

TickFault VelocityCheck::judge(const core::HandState& hand, double elapsed_s) noexcept {
  if (has_begun_) {
    integrated_m_ += elapsed_s * hand.velocity_m_s;
    window_s_ += elapsed_s;
    if (window_s_ < window_length_s) {
      return TickFault::none;
    }
    const core::Vec3 moved_m = hand.position_m - began_at_m_;
    const double larger_m = std::max(moved_m.norm(), integrated_m_.norm());
    if (larger_m >= noticeable_m) {
      const bool agrees = (moved_m - integrated_m_).norm() <= tolerance * larger_m;
      disagreements_ = std::max(disagreements_ + (agrees ? -1 : 1), 0);
    }
  }
  has_begun_ = true;
  began_at_m_ = hand.position_m;
  integrated_m_.setZero();
  window_s_ = 0.0;
  return disagreements_ > max_disagreements ? TickFault::velocity_wrong : TickFault::none;
}
}  // namespace tapstudy::device
