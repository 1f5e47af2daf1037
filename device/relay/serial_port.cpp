#include "device/relay/serial_port.hpp"

#include <termios.h>
namespace tapstudy::device {
bool set_up_serial_port(int descriptor) {
  termios modes{};
  if (tcgetattr(descriptor, &modes) != 0) {
    return false;
  }
  cfmakeraw(&modes);
  modes.c_cflag |= static_cast<tcflag_t>(CLOCAL);
  modes.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | CSTOPB | HUPCL);
  cfsetspeed(&modes, B115200);
  return tcsetattr(descriptor, TCSANOW, &modes) == 0;
}
}  // namespace tapstudy::device
