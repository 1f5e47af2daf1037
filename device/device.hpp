#pragma once
#include <string>

#include "core/error.hpp"
#include "core/haptic_state.hpp"
namespace tapstudy::device {
class DeviceError : public core::Error {
 public:
  using core::Error::Error;
};

// How often zero force is sent after a fault, for a packet may get lost.
inline constexpr int zero_force_packets = 3;

// What a device makes of its last tick.
struct DeviceDetail {
  core::Vec3 achieved_n{core::Vec3::Zero()};
  double pose_residual_m{0.0};
  double closure_margin{1.0};
};

// A force-feedback device, real or simulated, seen from the haptic thread: read() and write() are
// called in turn, once a tick. Device frame (core/haptic_state.hpp). Nothing here but description()
// throws, waits for a lock or takes memory of its own; a library below may: libusb allocates two
// small blocks a pair of transfers, and locks its own mutexes.
class Device {
 public:
  virtual ~Device() = default;
  // On a fault hand holds what was read of it, if anything was; the rest stays as it was.
  [[nodiscard]] virtual core::TickFault read(core::HandState& hand) noexcept = 0;
  [[nodiscard]] virtual core::TickFault write(const core::Vec3& force_n) noexcept = 0;
  // Before the first tick and after a pause.
  virtual void begin() noexcept {}
  // No force from now on; the device stays ready.
  virtual void zero_force() noexcept { static_cast<void>(write(core::Vec3::Zero())); }
  // After a fault: all outputs to zero at once, by every means there is.
  virtual void emergency_stop() noexcept { zero_force(); }
  virtual DeviceDetail detail() const noexcept = 0;
  // What it is, for the session's record.
  virtual std::string description() const = 0;
};
}  // namespace tapstudy::device
