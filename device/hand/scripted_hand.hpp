#pragma once
#include <cstdint>

#include "core/haptics/haptic_state.hpp"
#include "core/settings/device_settings.hpp"
#include "device/hand/hand_motion.hpp"
namespace tapstudy::device {
// One tap, made again and again.
struct RepeatedTap {
  core::HandBody body;
  core::Vec3 place_m{core::Vec3::Zero()};  // on the surface, plate frame
  double speed_m_s{};                      // > 0
  double dwell_s{};
  double pause_s{};  // > 0, until the next one begins
  double duration_s() const;
};

// A hand that taps in the participant's place, who holds the device still and feels what this hand
// feels. Each tap starts at rest above its place, so that all of them are alike whatever the
// participant's hand does. Device frame. Nothing here throws, locks or allocates but the
// constructor.
class ScriptedHand {
 public:
  ScriptedHand(const RepeatedTap& tap, const core::Placement& placement, double dt_s);
  const core::HandState& state() const noexcept { return body_.state(); }
  // One tick with this force on the hand.
  void move(const core::Vec3& force_n) noexcept;
  // The first tap begins now. Not to be called in contact.
  void restart() noexcept;

 private:
  core::Vec3 aim_m(std::int64_t tick) const noexcept;

  MuscleBody body_;
  double dt_s_;
  TapPath path_;
  std::int64_t period_ticks_;
  std::int64_t tick_{0};
};
}  // namespace tapstudy::device
