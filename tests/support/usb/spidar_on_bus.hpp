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
  explicit SpidarOnBus(std::uint16_t board_product = device::sh4_product,
                       std::chrono::microseconds reply_within = std::chrono::milliseconds{25})
      : product{board_product}, max_reply{reply_within} {}
  std::uint16_t product;
  std::chrono::microseconds max_reply;  // in the bus's time
  SimulatedSpidar hardware;
  FakeBus bus{device::cyverse_vendor, product,
              [this](auto request) { return hardware.answer(request); }};
  device::UsbNode node{node_of(bus)};
  device::LibusbPipe pipe{node, {}, max_reply, FakeBus::now};
  std::unique_ptr<device::SpidarBoard> board{device::board_of(product)};
  device::SpidarG6 spidar{pipe, *board, simulated_settings()};
};

// The outputs that a request to either board sets; empty if it sets none.
inline std::span<const std::uint8_t> outputs_in(const Bytes& request) {
  if (request.size() == 512) {
    return std::span{request}.subspan(2, 16);
  }
  return request.front() == 0x52 ? std::span{request}.subspan(1, 16)
                                 : std::span<const std::uint8_t>{};
}
inline bool has_no_force(const Bytes& request) {
  return std::ranges::all_of(outputs_in(request), [](std::uint8_t byte) { return byte == 0; });
}
}  // namespace tapstudy::testing
