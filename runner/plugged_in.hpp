#pragma once
#include <chrono>
#include <memory>
#include <vector>

#include "device/spidar/board.hpp"
#include "device/usb/guardian.hpp"
#include "device/usb/libusb_pipe.hpp"
namespace tapstudy::runner {
// Whether it is a SPIDAR-G6's board.
bool is_spidar(const device::UsbListing& listing);
// Every SPIDAR-G6 on the USB. Throws DeviceError if there is none.
std::vector<device::UsbListing> plugged_in_spidars();
// Throws DeviceError also if there are several.
device::UsbListing the_only_spidar();

// A board that is open and guarded, in the order of its making.
struct OpenBoard {
  OpenBoard(const device::UsbListing& listing, std::chrono::milliseconds longest_reply);
  device::UsbNode node;
  std::unique_ptr<device::SpidarBoard> board;
  device::Guardian guardian;
  device::LibusbPipe pipe;
};
}  // namespace tapstudy::runner
