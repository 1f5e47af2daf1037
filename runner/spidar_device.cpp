#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

#include "runner/exit_code.hpp"
#include "runner/operator_prompt.hpp"
#include "runner/plugged_in.hpp"
#include "runner/session_device.hpp"
namespace tapstudy::runner {
namespace {
constexpr int tightening_steps = 500;
constexpr std::chrono::milliseconds tightening_step{1};

// Everything between the plug and the loop, in the order of its making.
class SpidarDevice final : public SessionDevice {
 public:
  SpidarDevice(const device::UsbListing& listing, const protocols::SpidarRig& rig, double dt_s,
               LineInput& operator_input)
      : input_{operator_input},
        open_{listing, std::chrono::milliseconds{std::llround(1e3 * rig.longest_reply_s)}},
        spidar_{open_.pipe, *open_.board, watched(spidar_settings(rig, dt_s), open_.guardian)},
        round_trip_{round_trips(open_)} {}
  device::Device& device() override { return spidar_; }
  int rotary_switch() const { return spidar_.rotary_switch(); }
  std::optional<device::LatenessCount> round_trip() const override { return round_trip_; }
  void get_ready() override {
    if (!spidar_.is_homed()) {
      tighten();
      home();
    }
  }

 private:
  static device::SpidarSettings watched(device::SpidarSettings settings,
                                        device::Guardian& guardian) {
    settings.watch = &guardian.watch();
    return settings;
  }
  static void check(core::TickFault fault) {
    if (fault != core::TickFault::none) {
      throw device::DeviceError{fmt::format("SPIDAR-G6: {}", to_text(fault))};
    }
  }
  void tighten() {
    for (int step = 1; step <= tightening_steps; ++step) {
      check(spidar_.tighten(static_cast<double>(step) / tightening_steps));
      std::this_thread::sleep_for(tightening_step);
    }
  }
  void home() {
    if (!asked_and_done(input_, "\nHold the grip in the middle of the frame, not turned, and")) {
      throw Stopped{"stopped before the grip was in the middle"};
    }
    check(spidar_.home());
  }

  LineInput& input_;
  OpenBoard open_;
  device::SpidarG6 spidar_;
  device::LatenessCount round_trip_;
};
}  // namespace

std::unique_ptr<SessionDevice> plugged_in_spidar(const protocols::SpidarRig& rig, double dt_s,
                                                 LineInput& operator_input) {
  const std::vector<device::UsbListing> all = plugged_in_spidars();
  if (all.size() > 1 && !rig.rotary_switch) {
    throw device::DeviceError{fmt::format(
        "{} SPIDAR-G6 are plugged in: say in the rig which (spidar.rotary_switch)", all.size())};
  }
  for (const device::UsbListing& listing : all) {
    auto found = std::make_unique<SpidarDevice>(listing, rig, dt_s, operator_input);
    if (!rig.rotary_switch || found->rotary_switch() == *rig.rotary_switch) {
      return found;
    }
  }
  throw device::DeviceError{
      fmt::format("no SPIDAR-G6 with its rotary switch on {} is plugged in", *rig.rotary_switch)};
}
}  // namespace tapstudy::runner
