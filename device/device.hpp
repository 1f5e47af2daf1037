#pragma once
#include <string>

#include "core/error.hpp"
#include "core/haptic_state.hpp"
namespace tapstudy::device {
class DeviceError : public core::Error {
 public:
  using core::Error::Error;
};

enum class Io : bool { failed = false, ok = true };

// A force-feedback device, real or simulated, seen from the haptic thread: read() and write() are
// called in turn, once a tick; they do not allocate, lock or throw. Device frame (core).
class Device {
 public:
  virtual ~Device() = default;
  [[nodiscard]] virtual Io read(core::HandState& hand) noexcept = 0;
  [[nodiscard]] virtual Io write(const core::Vec3& force_n) noexcept = 0;
  // What it is, for the session's record.
  virtual std::string description() const = 0;
};
}  // namespace tapstudy::device
