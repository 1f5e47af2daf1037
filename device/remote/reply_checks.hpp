#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "core/haptics/haptic_state.hpp"
#include "device/remote/packets.hpp"
namespace tapstudy::device {
// Of a measured force: less may be an offset, noise, or lost in friction.
inline constexpr double noticeable_n = 0.5;

// A device may report its force, not exert it, so much later than it was sent.
inline constexpr double max_report_lag_s = 0.02;

// Compares the force that a device reports with those that it was sent within max_report_lag_s.
// Faults are a report more than twice and 1 N above the largest of them along it, for 3 ms; one
// against the force while none was sent that way, for 6 ms; and one of almost nothing for 30 ms
// longer than the lag. Margins are wide, since devices measure coarsely. One that has never
// reported any (NaN) is not judged; one that no longer does for longer than the lag is a fault.
class ExertedForce {
 public:
  void forget() noexcept {
    const bool has_told = has_told_;
    *this = {};
    has_told_ = has_told;
  }
  bool has_told() const noexcept { return has_told_; }
  // Once a reply, with what was commanded when the device reported, and the time since the last.
  [[nodiscard]] core::TickFault judge(const core::Vec3& commanded_n, const core::Vec3& reported_n,
                                      double elapsed_s) noexcept;

 private:
  // The box of the commands of half a lag.
  struct Commands {
    core::Vec3 low_n{core::Vec3::Zero()};
    core::Vec3 high_n{core::Vec3::Zero()};
  };
  void remember(const core::Vec3& commanded_n, double elapsed_s) noexcept;
  double largest_along(const core::Vec3& direction) const noexcept;

  std::array<Commands, 3> recent_{};  // the current half lag first
  double current_s_{0.0};
  double above_s_{0.0};
  double against_s_{0.0};
  double without_s_{0.0};
  bool has_told_{false};  // in this session
  double untold_s_{0.0};
};

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

// Finds a program that replies although its device gives no new samples: an age, or a time without
// a higher number, above the limit. A number that falls, or rises by twice as many as the device's
// rate explains, is none of its samples.
class SampleCheck {
 public:
  SampleCheck(double max_age_s, double rate_hz) noexcept
      : max_age_s_{max_age_s}, rate_hz_{rate_hz} {}
  void forget() noexcept { is_known_ = false; }
  // Once a reply, with the time since the last one.
  [[nodiscard]] core::TickFault judge(const RemoteSample& sample, double elapsed_s) noexcept;
  // Whether the sample judged last had a new number.
  bool is_new() const noexcept { return still_s_ == 0.0; }

 private:
  double max_age_s_;
  double rate_hz_;
  bool is_known_{false};
  std::uint64_t number_{0};
  double still_s_{0.0};
};

// Counts the samples that a device took after it was sent zero force. One whose number is not above
// that in the first reply to it, or that is older than the request, is from before: a device whose
// samples are repeated, or come out of a queue, has none.
class SamplesSince {
 public:
  // Once a reply, with the time since zero force was first sent. Those before a force are
  // forgotten.
  int counted(const RemoteSample& sample, bool is_force_exerted, double since_s) noexcept;

 private:
  std::optional<std::uint64_t> number_;
  int count_{0};
};
}  // namespace tapstudy::device
