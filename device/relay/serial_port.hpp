#pragma once
namespace tapstudy::device {
// Sets an open serial port to raw bytes at 115 200 baud, 8N1 without flow control; its lines stay
// as they are when it is closed. False if the descriptor is of something else, or refuses.
bool set_up_serial_port(int descriptor);
}  // namespace tapstudy::device
