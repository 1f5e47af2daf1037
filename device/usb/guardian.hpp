#pragma once
#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "device/usb/usb_node.hpp"
#include "device/usb/watchdog_channel.hpp"
namespace tapstudy::device {
struct GuardianSettings {
  std::uint8_t out_endpoint{};
  std::uint8_t in_endpoint{};
  std::vector<std::uint8_t> zero_force_packet;
  double max_stall_s{0.02};  // the program is considered stalled after this time without heartbeat
  int fifo_priority{0};      // asked for; 0: none
  int relay{-1};             // descriptor of a dead-man relay's port; -1: there is none
};

// A watchdog process that outlives this one. The boards are not known to have a watchdog: should
// tapstudy die with force on, for any reason including SIGKILL, the strings would keep pulling. So
// a child process holds the device's open node and waits on a pipe whose other end only tapstudy
// has; when that closes, it sends the zero-force packet three times and exits. It sends it in every
// round of 5 ms, and keeps running, as long as tapstudy is stalled with force on (suspended or
// starved of CPU time), and where tapstudy could not confirm zero force itself: a halted endpoint
// is cleared first. It asks for a priority above the loop's and for locked memory of its own, and
// tapstudy offers itself to the kernel's out-of-memory killer first. It also gives the sign of life
// to a dead-man relay (device/relay), from the first confirmed zero force on and
// unless it has taken over or repeats zero force.
// Why not a library: none outlives the process that it is linked into. A supervisor such as systemd
// does, but would start a program that opens the device anew, where this child holds it already.
class Guardian {
 public:
  // May be called with other threads running: the child uses no locks they could hold. Throws
  // DeviceError if it cannot be started.
  Guardian(const UsbNode& node, GuardianSettings settings);
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
