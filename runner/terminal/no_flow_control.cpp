#include "runner/terminal/no_flow_control.hpp"

#include <termios.h>
#include <unistd.h>
namespace tapstudy::runner {
NoFlowControl::NoFlowControl(int descriptor) : descriptor_{descriptor} {
  termios modes{};
  if (isatty(descriptor_) == 0 || tcgetattr(descriptor_, &modes) != 0) {
    return;
  }
  input_modes_ = modes.c_iflag;
  modes.c_iflag &= ~static_cast<tcflag_t>(IXON);
  tcsetattr(descriptor_, TCSANOW, &modes);
}

NoFlowControl::~NoFlowControl() {
  termios modes{};
  if (input_modes_ && tcgetattr(descriptor_, &modes) == 0) {
    modes.c_iflag = *input_modes_;
    tcsetattr(descriptor_, TCSANOW, &modes);
  }
}
}  // namespace tapstudy::runner
