#pragma once
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/loop/tick_clock.hpp"
#include "device/relay/serial_port.hpp"
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

struct BoardSettings {
  std::chrono::microseconds max_reply{100'000};
  double max_stall_s{0.02};  // the guardian acts after it
  int guardian_priority{0};  // SCHED_FIFO; 0: none
  std::string relay{};       // serial port of a dead-man relay; empty: there is none
};

// An open board with its guardian; members in order of construction.
struct OpenBoard {
  explicit OpenBoard(const UsbListing& listing, const BoardSettings& settings = {});
  UsbNode node;
  std::unique_ptr<SpidarBoard> board;
  std::optional<DeadManRelay> relay;
  Guardian guardian;
  LibusbPipe pipe;
};

// Round-trip times of the board over a number of requests, at zero force. Throws DeviceError if it
// does not reply.
LatenessCount round_trips(OpenBoard& open);
// The setting of the board's rotary switch, by one exchange at zero force, without a relay: the
// amplifier of another board must stay off. Throws as OpenBoard and exchange_zero_force.
int rotary_switch_of(const UsbListing& listing);
// One exchange at zero force. Throws DeviceError if the board does not reply.
void exchange_zero_force(OpenBoard& open);
}  // namespace tapstudy::device
