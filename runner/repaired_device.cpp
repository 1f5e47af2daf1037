#include "runner/repaired_device.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "device/device.hpp"
#include "runner/plugged_in.hpp"
#include "runner/stop_signal.hpp"
namespace tapstudy::runner {
namespace {
bool is_there(const protocols::Rig& rig) {
  const auto all = device::usb_devices();
  return !rig.spidar || std::ranges::any_of(all, [](const device::UsbListing& listing) {
    return is_spidar(listing) && listing.may_open;
  });
}

device::DeviceError gives_up(const Interruption& interruption) {
  return device::DeviceError{to_text(interruption) + " (go on with --resume)"};
}
}  // namespace

std::unique_ptr<SessionDevice> repaired_device(const Interruption& interruption,
                                               const protocols::Rig& rig, double dt_s,
                                               LineInput& operator_input,
                                               std::unique_ptr<SessionDevice> broken) {
  const bool has_hardware = rig.spidar || rig.remote_port;
  broken.reset();  // only one can hold the device
  if (!has_hardware) {
    throw gives_up(interruption);
  }
  fmt::print(stderr,
             "\n{}.\nType quit to stop here; or see to the device, its power and its plug, and to "
             "go on press Enter. ",
             to_text(interruption));
  while (const auto line = operator_input.next([] { return !stop_was_asked(); })) {
    if (!line->empty()) {
      break;
    }
    if (is_there(rig)) {
      return device_of_rig(rig, dt_s, operator_input);
    }
    fmt::print(stderr, "It is not there yet. To try again press Enter. ");
  }
  throw gives_up(interruption);
}
}  // namespace tapstudy::runner
