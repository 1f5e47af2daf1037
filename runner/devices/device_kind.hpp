#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "protocols/rig_device.hpp"
#include "runner/devices/session_device.hpp"
namespace tapstudy::runner {
// The context in which a device is opened.
struct DeviceRequest {
  const protocols::Protocol& protocol;
  const protocols::Rig& rig;
  // Asks the operator to do something; false if the session is to stop instead.
  std::function<bool(const std::string& task)> ask_operator;
};

// A kind of device: its section of the rig (protocols::RigDevice), its detection, and how it is
// opened. To add one: a file in this folder with its class, a row in device_table.cpp, and its
// section in protocols/schema/devices. Only what is the device's own (its calibration and the
// command for it) refers to it by name.
class DeviceKind : public protocols::RigDevice {
 public:
  // Throws InvalidInput if its section of the rig is implausible.
  virtual void check(const protocols::Rig& /*rig*/) const {}
  // Throws DeviceError if it does not reply, InvalidInput if the rig refers to what does not exist.
  virtual std::unique_ptr<SessionDevice> open(const DeviceRequest& request) const = 0;
  // Whether it can hold its grip there, in the device frame.
  virtual bool reaches(const protocols::Rig& /*rig*/, const core::Vec3& /*at_m*/) const {
    return true;
  }
  // Whether it is present and could be opened now.
  virtual bool is_there() const { return true; }
  // How many ticks later than a force is computed it is exerted: it lowers the stability bound of
  // the contact (device/hand/penalty_limit.hpp).
  virtual int delay_ticks(const protocols::Rig& /*rig*/) const { return 0; }
  // Whether its hand is a participant's, or a simulation of one.
  virtual bool has_participant() const { return true; }

  // What is plugged in of this kind, a line each.
  virtual std::vector<std::string> listing() const { return {}; }
  // One exchange with the device at zero force, for measurements: empty for a kind without a
  // communication link. Throws DeviceError if none answers, now or when called; of several devices
  // the first that may be opened is taken.
  virtual std::function<void()> zero_force_exchange(const protocols::Rig& /*rig*/) const {
    return {};
  }
  // Tries whether the device lets go of the force by itself when the program falls silent, at zero
  // force; what was found, or empty if there is nothing to try. Throws DeviceError if it does not.
  virtual std::string tried_release(const protocols::Rig& /*rig*/) const { return {}; }
};

// All there are.
const std::vector<const DeviceKind*>& device_kinds();
const DeviceKind& kind_of(const protocols::Rig& rig);
}  // namespace tapstudy::runner
