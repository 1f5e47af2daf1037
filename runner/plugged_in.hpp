#pragma once
#include <chrono>
#include <memory>
#include <vector>

#include "device/lateness.hpp"
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

// How long the board takes from request to reply, over some of them, without force. Throws
// DeviceError if it does not answer.
device::LatenessCount round_trips(OpenBoard& open);
// The same of a board that is opened for it.
device::LatenessCount probed_round_trip(const device::UsbListing& listing);
}  // namespace tapstudy::runner
