#pragma once
#include <memory>
#include <optional>

#include "core/rng.hpp"
#include "device/lateness.hpp"
#include "protocols/protocol.hpp"
#include "protocols/rig.hpp"
#include "runner/line_input.hpp"
#include "runner/rig.hpp"
namespace tapstudy::runner {
// What the participant's hand meets in a session, with all that must live as long.
class SessionDevice {
 public:
  virtual ~SessionDevice() = default;
  virtual device::Device& device() = 0;
  // Before every trial, with the device's loop at rest. May ask the operator for something.
  virtual void get_ready() = 0;
  // From request to reply, where the device is asked over a wire.
  virtual std::optional<device::LatenessCount> round_trip() const { return std::nullopt; }
};

// The device of the rig; nothing where the hand is simulated. Throws DeviceError if it does not
// answer, InvalidInput if the rig asks for what is not there.
std::unique_ptr<SessionDevice> device_of_rig(const protocols::Rig& rig, double dt_s,
                                             LineInput& operator_input);

// A hand that taps by itself, on points drawn from the seed.
std::unique_ptr<SessionDevice> simulated_device(const protocols::Protocol& protocol,
                                                const core::Placement& placement,
                                                std::uint64_t seed);
// The SPIDAR-G6 that is plugged in; the operator is asked to hold its grip in the middle before the
// first trial. Throws DeviceError if there is none, more than one, or it does not answer.
std::unique_ptr<SessionDevice> plugged_in_spidar(const protocols::SpidarRig& rig, double dt_s,
                                                 LineInput& operator_input);
}  // namespace tapstudy::runner
