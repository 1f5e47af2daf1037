#pragma once
#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "device/usb/usb_node.hpp"
#include "device/usb/watchdog_channel.hpp"
namespace tapstudy::device {
// A watchdog process that outlives this one. The boards are not known to have a watchdog: should
// tapstudy die with force on, for any reason including SIGKILL, the strings would keep pulling. So
// a child process holds the device's open node and waits on a pipe whose other end only tapstudy
// has; when that closes, it sends the zero-force packet three times and exits. It does the same,
// but keeps running, if tapstudy stalls with force on, suspended or starved of CPU time.
// Why not a library: none outlives the process that it is linked into. A supervisor such as systemd
// does, but would start a program that opens the device anew, where this child holds it already and
// ends the force some 100 ms after the last sign of life.
class Guardian {
 public:
  // May be called with other threads running: the child uses no locks they could hold. Throws
  // DeviceError if it cannot be started.
  Guardian(const UsbNode& node, std::uint8_t out_endpoint,
           std::vector<std::uint8_t> zero_force_packet);
  // The zero-force packet is sent on normal termination, too.
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
