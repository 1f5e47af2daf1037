#pragma once
#include "core/haptic_state.hpp"
#include "core/tick_fault.hpp"
namespace tapstudy::device {
// Compares the velocity that a device reports with the change of its position, since the strength
// of an impact rests on the velocity: one in other units, of another frame or always 0 is a fault
// after about a second of movement. Judged in windows of 50 ms in which the hand moves noticeably;
// a velocity that lags behind by some 30 ms disagrees only where the hand turns back.
class VelocityCheck {
 public:
  void forget() noexcept { *this = {}; }
  // Once a reply, with the time since the last one.
  [[nodiscard]] core::TickFault judge(const core::HandState& hand, double elapsed_s) noexcept;

 private:
  bool has_begun_{false};
  core::Vec3 began_at_m_{core::Vec3::Zero()};
  core::Vec3 integrated_m_{core::Vec3::Zero()};
  double window_s_{0.0};
  int disagreements_{0};  // less the agreements, from 0
};
}  // namespace tapstudy::device
