#include "runner/session_device.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "core/error.hpp"
#include "device/remote/remote_hand.hpp"
#include "device/replay_hand.hpp"
#include "results/store.hpp"
#include "runner/only_one.hpp"
namespace tapstudy::runner {
namespace {
// Of another program to a tick's question.
constexpr std::chrono::milliseconds longest_reply{3};

class RemoteDevice final : public SessionDevice {
 public:
  explicit RemoteDevice(std::uint16_t port)
      : only_one_{fmt::format("remote device at port {}", port),
                  fmt::format("remote: UDP port {} is in use by another session", port)},
        hand_{port, longest_reply} {}
  device::Device& device() override { return hand_; }
  void get_ready() override {}

 private:
  OnlyOne only_one_;
  device::RemoteHand hand_;
};

class ReplayedDevice final : public SessionDevice {
 public:
  explicit ReplayedDevice(device::ReplayHand hand) : hand_{std::move(hand)} {}
  device::Device& device() override { return hand_; }
  void get_ready() override { hand_.rewind(); }

 private:
  device::ReplayHand hand_;
};

// The hand of a stored trial.
device::ReplayHand hand_of(const protocols::ReplayRig& rig) {
  const std::vector<core::TraceSample> trace =
      results::Store::open_existing(rig.directory).trace(rig.trial_id);
  std::string source = fmt::format("trial {} of {}", rig.trial_id, rig.directory);
  if (trace.empty()) {
    throw core::InvalidInput{"rig: replay: there is no trace of " + source};
  }
  std::vector<core::HandState> states;
  states.reserve(trace.size());
  for (const core::TraceSample& sample : trace) {
    states.push_back(
        {core::Vec3{sample.position_m[0], sample.position_m[1], sample.position_m[2]},
         core::Vec3{sample.velocity_m_s[0], sample.velocity_m_s[1], sample.velocity_m_s[2]}});
  }
  return {std::move(states), std::move(source)};
}
}  // namespace

std::unique_ptr<SessionDevice> device_of_rig(const protocols::Rig& rig, double dt_s,
                                             LineInput& operator_input) {
  if (rig.spidar) {
    return plugged_in_spidar(*rig.spidar, dt_s, operator_input);
  }
  if (rig.remote_port) {
    return std::make_unique<RemoteDevice>(*rig.remote_port);
  }
  if (rig.replay) {
    return std::make_unique<ReplayedDevice>(hand_of(*rig.replay));
  }
  return nullptr;
}
}  // namespace tapstudy::runner
