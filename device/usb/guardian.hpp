#pragma once
#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "device/usb/usb_node.hpp"
#include "device/usb/watchdog_channel.hpp"
namespace tapstudy::device {
// A process that outlives this one. The boards are not known to have a watchdog: should tapstudy
// die with force on, whatever from, SIGKILL included, the strings would keep pulling. So a child
// holds the device's open node and waits for a pipe of which only tapstudy has the other end; when
// that closes it sends the packet of no force, three times, by itself, and ends. It does the same,
// and lives on, if tapstudy stands still with force on: suspended, or starved.
// Why not a library: none outlives the process that it is linked into. A supervisor such as systemd
// does, but would start a program that opens the device anew, where this child holds it already and
// ends the force some 100 ms after the last sign of life.
class Guardian {
 public:
  // Other threads may run: the child calls nothing that they could hold. Throws DeviceError if
  // there can be none.
  Guardian(const UsbNode& node, std::uint8_t out_endpoint,
           std::vector<std::uint8_t> zero_force_packet);
  // The packet is sent at an orderly end too.
  ~Guardian();
  Guardian(const Guardian& other) = delete;
  Guardian& operator=(const Guardian& other) = delete;
  Guardian(Guardian&& other) = delete;
  Guardian& operator=(Guardian&& other) = delete;
  WatchdogChannel& channel() noexcept { return *channel_; }

 private:
  struct Unmap {
    void operator()(WatchdogChannel* channel) const noexcept;
  };
  static std::unique_ptr<WatchdogChannel, Unmap> shared_channel();

  std::unique_ptr<WatchdogChannel, Unmap> channel_;  // in memory shared with the child
  pid_t child_{-1};
  int life_{-1};  // closed by the kernel when this process ends
};
}  // namespace tapstudy::device
