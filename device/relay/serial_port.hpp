#pragma once
#include <string>
namespace tapstudy::device {
// Sets an open serial port to raw bytes at 115 200 baud, 8N1 without flow control; its lines stay
// as they are when it is closed. False if the descriptor is of something else, or refuses.
bool set_up_serial_port(int descriptor);

// A relay in the supply of a device's amplifier, at a serial port: a small microcontroller that
// closes it while bytes arrive, and opens it 50 ms after the last one. It takes the force off where
// no program can: both processes dead or frozen, a crashed kernel, a host controller that hangs.
//   port: 115 200 baud, 8 data bits, no parity, one stop bit; any byte is a sign of life
// The guardian sends one every 10 ms (guardian.hpp), unless it has taken over or repeats zero
// force.
class DeadManRelay {
 public:
  // Throws DeviceError if the port cannot be opened, is not a serial port, or is in use.
  explicit DeadManRelay(const std::string& port);
  ~DeadManRelay();
  DeadManRelay(const DeadManRelay&) = delete;
  DeadManRelay& operator=(const DeadManRelay&) = delete;
  DeadManRelay(DeadManRelay&&) = delete;
  DeadManRelay& operator=(DeadManRelay&&) = delete;
  int descriptor() const noexcept { return descriptor_; }  // writes to it never block

 private:
  int descriptor_;
};
}  // namespace tapstudy::device
