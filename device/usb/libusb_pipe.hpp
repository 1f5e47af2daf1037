#pragma once
#include <chrono>
#include <memory>

#include "device/loop/tick_clock.hpp"
#include "device/usb/usb_node.hpp"
#include "device/usb/usb_pipe.hpp"
namespace tapstudy::device {
struct BulkEndpoints {
  std::uint8_t out{0x02};
  std::uint8_t in{0x86};
};

using PipeClock = Nanoseconds (*)() noexcept;
Nanoseconds monotonic_now() noexcept;

// libusb-1.0 on an open node: the request and the read of its reply are submitted together. libusb
// itself allocates a little memory for each transfer; nothing else here does.
class LibusbPipe final : public UsbPipe {
 public:
  // Claims interface 0. The node must outlive the pipe. A reply is waited for until max_reply after
  // its request, by this clock. Throws DeviceError.
  LibusbPipe(const UsbNode& node, const BulkEndpoints& endpoints,
             std::chrono::microseconds max_reply, PipeClock now = monotonic_now);
  ~LibusbPipe() override;
  LibusbPipe(const LibusbPipe& other) = delete;
  LibusbPipe& operator=(const LibusbPipe& other) = delete;
  LibusbPipe(LibusbPipe&& other) = delete;
  LibusbPipe& operator=(LibusbPipe&& other) = delete;

  UsbOutcome send(std::span<const std::uint8_t> out) noexcept override;
  UsbOutcome exchange(std::span<const std::uint8_t> out,
                      std::span<std::uint8_t> in) noexcept override;
  UsbOutcome receive(std::span<std::uint8_t> in) noexcept override;
  void clear_halt() noexcept override;
  void drain() noexcept override;

 private:
  struct Libusb;  // keeps libusb.h out of this header
  std::unique_ptr<Libusb> libusb_;
};
}  // namespace tapstudy::device
