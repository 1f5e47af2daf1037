#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "protocols/rig_device.hpp"
#include "runner/devices/session_device.hpp"
#include "runner/terminal/line_input.hpp"
namespace tapstudy::runner {
// What a device is opened for.
struct DeviceRequest {
  const protocols::Protocol& protocol;
  const protocols::Rig& rig;
  LineInput& operator_input;
};

// A kind of device: its section of the rig (protocols::RigDevice), what is plugged in, and how it
// is opened. Adding one: a file in this folder with its class, a row in device_table.cpp, and its
// section of the rig's JSON schema; nothing else knows a device by its name.
class DeviceKind : public protocols::RigDevice {
 public:
  // Throws InvalidInput if its section of the rig cannot be true.
  virtual void check(const protocols::Rig& /*rig*/) const {}
  // Throws DeviceError if it does not answer, InvalidInput if the rig asks for what is not there.
  virtual std::unique_ptr<SessionDevice> open(const DeviceRequest& request) const = 0;
  // Whether it could be opened now.
  virtual bool is_there() const { return true; }
  // Whether its hand is a participant's, or a simulation of one.
  virtual bool has_participant() const { return true; }

  // What is plugged in of this kind, a line each.
  virtual std::vector<std::string> listing() const { return {}; }
  // From request to reply, measured now, without force; nothing for a kind that is not asked over
  // a wire. Throws DeviceError if there is not exactly one to ask.
  virtual std::optional<device::LatenessCount> round_trip() const { return std::nullopt; }
};

// All there are.
const std::vector<const DeviceKind*>& device_kinds();
const DeviceKind& kind_of(const protocols::Rig& rig);
}  // namespace tapstudy::runner
