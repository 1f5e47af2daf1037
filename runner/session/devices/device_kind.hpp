#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/device.hpp"
#include "device/loop/tick_clock.hpp"
#include "protocols/protocol.hpp"
#include "protocols/reader/read_rig.hpp"
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
  // What was found when it was tried, at zero force, whether the device lets go of the force when
  // the program falls silent; empty if there is nothing to try.
  virtual std::string release() const { return {}; }
  // What the device itself says to the operator; empty: nothing. Any thread, while the loop runs.
  virtual std::string text_for_operator() const { return {}; }
};

// The context in which a device is opened.
struct DeviceRequest {
  const protocols::Protocol& protocol;
  const protocols::Rig& rig;
  // Asks the operator to do something, in whole sentences; false if the session is to stop instead.
  std::function<bool(const std::string& task)> ask_operator;
};

// A kind of device: its section of the rig (protocols::RigDevice), its detection, and how it is
// opened. To add one: a file in this folder with its class, a row in device_kind.cpp. Only what is
// the device's own (its calibration and the command for it) refers to it by name.
class DeviceKind : public protocols::RigDevice {
 public:
  // Throws InvalidInput if its section of the rig is implausible.
  virtual void check(const protocols::Rig& /*rig*/) const {}
  // Throws DeviceError if it does not reply or does not let go of the force when the program falls
  // silent, InvalidInput if the rig refers to what does not exist.
  virtual std::unique_ptr<SessionDevice> open(const DeviceRequest& request) const = 0;
  // Whether it can hold its grip there, in the device frame.
  virtual bool reaches(const protocols::Rig& /*rig*/, const core::Vec3& /*at_m*/) const {
    return true;
  }
  // Whether it is present and could be opened now.
  virtual bool is_there() const { return true; }
  // How much later than a force is computed it is exerted: it lowers the stability bound of the
  // contact (device/hand/penalty_limit.hpp).
  virtual double force_delay_s(const protocols::Rig& /*rig*/, double /*period_s*/) const {
    return 0.0;
  }
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
  // SessionDevice::release() without a session.
  virtual std::string tried_release(const protocols::Rig& /*rig*/) const { return {}; }
};

// All there are.
const std::vector<const DeviceKind*>& device_kinds();
const DeviceKind& kind_of(const protocols::Rig& rig);

// The key `max_reply_s` of a device with a communication link.
double read_max_reply_s(protocols::MapReader& section, double usual_s);

// A simulated hand that taps points drawn from the session's seed.
const DeviceKind& simulated_hand();
// A SPIDAR-G6 on the USB. The operator is asked to hold its grip in the middle before the first
// trial.
const DeviceKind& spidar_g6();
// A device that another program on this machine drives.
const DeviceKind& remote_device();
// Replays the hand of a stored trial.
const DeviceKind& replayed_hand();

// Tells the operator what ended the trial, waits until the device has been checked, and reopens it.
// Throws DeviceError if the operator chooses to stop, or if there is no hardware to check.
std::unique_ptr<SessionDevice> reconnect(const std::string& what_happened,
                                         const DeviceRequest& request,
                                         std::unique_ptr<SessionDevice> broken);
}  // namespace tapstudy::runner
