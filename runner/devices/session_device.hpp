#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "device/device.hpp"
#include "device/loop/lateness.hpp"
namespace tapstudy::runner {
// The device of a session, with everything that must share its lifetime.
class SessionDevice {
 public:
  virtual ~SessionDevice() = default;
  virtual device::Device& device() = 0;
  virtual std::string description() { return device().description(); }
  // Called once, when the session's seed has been stored.
  virtual void begin_session(std::uint64_t /*seed*/) {}
  // Called before every trial, with the loop stopped. May prompt the operator.
  virtual void get_ready() = 0;
  // Communication round trip, if the device has a communication link.
  virtual std::optional<device::LatenessCount> round_trip() const { return std::nullopt; }
};
}  // namespace tapstudy::runner
