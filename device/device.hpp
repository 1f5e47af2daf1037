#pragma once
#include <string>

#include "core/error.hpp"
#include "core/haptic_state.hpp"
namespace tapstudy::device {
class DeviceError : public core::Error {
 public:
  using core::Error::Error;
};

// How many times zero force is sent after a fault, because a packet may be lost.
inline constexpr int zero_force_packets = 3;

// What a device reports about its last tick.
struct DeviceDetail {
  core::Vec3 achieved_n{core::Vec3::Zero()};
  double pose_residual_m{0.0};
  double closure_margin{1.0};
};

// A force-feedback device, real or simulated, as used by the haptic thread: read() and write() are
// called alternately, once per tick. Device frame (core/haptic_state.hpp). Apart from
// description(), nothing here throws, locks or allocates; an underlying library may: libusb
// allocates two small blocks per pair of transfers, and locks its own mutexes.
class Device {
 public:
  virtual ~Device() = default;
  // On a fault, hand holds whatever could be read; the rest is unchanged.
  [[nodiscard]] virtual core::TickFault read(core::HandState& hand) noexcept = 0;
  [[nodiscard]] virtual core::TickFault write(const core::Vec3& force_n) noexcept = 0;
  // Called before the first tick and after a pause.
  virtual void begin() noexcept {}
  // Commands zero force; the device stays ready.
  virtual void zero_force() noexcept { static_cast<void>(write(core::Vec3::Zero())); }
  // After a fault: sets all outputs to zero immediately, by all available means.
  virtual void emergency_stop() noexcept { zero_force(); }
  virtual DeviceDetail detail() const noexcept = 0;
  // Identification, for the session's record.
  virtual std::string description() const = 0;
};
}  // namespace tapstudy::device
