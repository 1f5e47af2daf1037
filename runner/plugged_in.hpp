#pragma once
#include <vector>

#include "device/usb/usb_node.hpp"
namespace tapstudy::runner {
// Every SPIDAR-G6 on the USB. Throws DeviceError if there is none.
std::vector<device::UsbListing> plugged_in_spidars();
// Throws DeviceError also if there are several.
device::UsbListing the_only_spidar();
}  // namespace tapstudy::runner
