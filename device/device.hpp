#pragma once
#include <string>

#include "core/error.hpp"
#include "core/haptic_state.hpp"
namespace tapstudy::device {
class DeviceError : public core::Error {
 public:
  using core::Error::Error;
};

// How often "no force" is said after a fault, for a packet may get lost.
inline constexpr int times_no_force_is_said = 3;

// What a device makes of its last tick.
struct DeviceDetail {
  core::Vec3 achieved_n{core::Vec3::Zero()};
  double pose_residual_m{0.0};
  double closure_margin{1.0};
};

// A force-feedback device, real or simulated, seen from the haptic thread: read() and write() are
// called in turn, once a tick; nothing here but description() allocates, locks or throws. Device
// frame (core).
class Device {
 public:
  virtual ~Device() = default;
  [[nodiscard]] virtual core::TickFault read(core::HandState& hand) noexcept = 0;
  [[nodiscard]] virtual core::TickFault write(const core::Vec3& force_n) noexcept = 0;
  // Before the first tick and after a pause.
  virtual void begin() noexcept {}
  // No force from now on; the device stays ready.
  virtual void rest() noexcept { static_cast<void>(write(core::Vec3::Zero())); }
  // After a fault: everything off at once, by all means there are.
  virtual void drop() noexcept { rest(); }
  virtual DeviceDetail detail() const noexcept = 0;
  // What it is, for the session's record.
  virtual std::string description() const = 0;
};
}  // namespace tapstudy::device
