#pragma once
#include <libusb.h>

#include <algorithm>
#include <memory>

#include "device/spidar/spidar_g6.hpp"
#include "device/usb/libusb_pipe.hpp"
#include "support/usb/fake_bus.hpp"
#include "support/usb/simulated_spidar.hpp"
namespace tapstudy::testing {
// There is no bus to list: the descriptor is all there is.
inline device::UsbNode node_of(FakeBus& bus) {
  libusb_set_option(nullptr, LIBUSB_OPTION_NO_DEVICE_DISCOVERY);
  return device::UsbNode{bus.open()};
}

inline device::SpidarSettings simulated_settings() {
  return {device::spidar_geometry("X3R"), SimulatedSpidar::calibration(), {}, 1e-3};
}

// The real libusb between a SpidarG6 and a simulated one.
struct SpidarOnBus {
  SimulatedSpidar hardware;
  FakeBus bus{device::cyverse_vendor, device::sh4_product,
              [this](auto request) { return hardware.answer(request); }};
  device::UsbNode node{node_of(bus)};
  // half of what a late reply takes, and ample for a machine that runs other tests meanwhile
  device::LibusbPipe pipe{node, {}, std::chrono::milliseconds{25}};
  std::unique_ptr<device::SpidarBoard> board{device::board_of(device::sh4_product)};
  device::SpidarG6 spidar{pipe, *board, simulated_settings()};
};

inline bool has_no_force(const Bytes& sh4_request) {
  return std::all_of(sh4_request.begin() + 2, sh4_request.begin() + 18,
                     [](std::uint8_t byte) { return byte == 0; });
}
}  // namespace tapstudy::testing
