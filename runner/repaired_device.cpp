#include "runner/repaired_device.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "device/device.hpp"
#include "runner/operator_prompt.hpp"
#include "runner/plugged_in.hpp"
namespace tapstudy::runner {
namespace {
bool is_there(const protocols::Rig& rig) {
  return !rig.spidar ||
         std::ranges::any_of(device::usb_devices(), [](const device::UsbListing& listing) {
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
  if (!rig.has_hardware()) {
    throw gives_up(interruption);
  }
  broken.reset();  // only one can hold the device
  std::string task = fmt::format(
      "\n{}.\nType quit to stop here; or see to the device, its power and its plug, and to "
      "go on",
      to_text(interruption));
  while (asked_and_done(operator_input, task)) {
    if (is_there(rig)) {
      return device_of_rig(rig, dt_s, operator_input);
    }
    task = "It is not there yet. To try again";
  }
  throw gives_up(interruption);
}
}  // namespace tapstudy::runner
