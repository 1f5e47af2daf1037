#pragma once
#include <chrono>
#include <memory>
#include <vector>

#include "device/loop/lateness.hpp"
#include "device/spidar/board.hpp"
#include "device/usb/guardian.hpp"
#include "device/usb/libusb_pipe.hpp"
namespace tapstudy::device {
// Whether it is a SPIDAR-G6's board.
bool is_spidar(const UsbListing& listing);
// Every SPIDAR-G6 on the USB. Throws DeviceError if there is none.
std::vector<UsbListing> find_spidars();
// Throws DeviceError also if there are several.
UsbListing find_only_spidar();

// An open board with its guardian; members in order of construction.
struct OpenBoard {
  OpenBoard(const UsbListing& listing, std::chrono::milliseconds max_reply);
  UsbNode node;
  std::unique_ptr<SpidarBoard> board;
  Guardian guardian;
  LibusbPipe pipe;
};

// Round-trip times of the board over a number of requests, at zero force. Throws DeviceError if it
// does not reply.
LatenessCount round_trips(OpenBoard& open);
// The same for a board opened for this purpose.
LatenessCount probed_round_trip(const UsbListing& listing);
}  // namespace tapstudy::device
