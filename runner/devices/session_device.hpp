#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "device/device.hpp"
#include "device/loop/lateness.hpp"
namespace tapstudy::runner {
// What the participant's hand meets in a session, with all that must live as long.
class SessionDevice {
 public:
  virtual ~SessionDevice() = default;
  virtual device::Device& device() = 0;
  virtual std::string description() { return device().description(); }
  // Once, when the session's seed is in the store.
  virtual void begin_session(std::uint64_t /*seed*/) {}
  // Before every trial, with the device's loop at rest. May ask the operator for something.
  virtual void get_ready() = 0;
  // From request to reply, where the device is asked over a wire.
  virtual std::optional<device::LatenessCount> round_trip() const { return std::nullopt; }
};
}  // namespace tapstudy::runner
