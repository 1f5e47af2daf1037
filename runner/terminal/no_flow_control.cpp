#include "runner/terminal/no_flow_control.hpp"

#include <termios.h>
#include <unistd.h>
namespace tapstudy::runner {
namespace {
// A program in the background that changed the terminal would be stopped for it.
bool is_ours(int descriptor) {
  const pid_t foreground = tcgetpgrp(descriptor);  // -1: a terminal that controls nobody here
  return isatty(descriptor) != 0 && (foreground < 0 || foreground == getpgrp());
}
}  // namespace

NoFlowControl::NoFlowControl(int descriptor) : descriptor_{descriptor} {
  termios modes{};
  if (!is_ours(descriptor_) || tcgetattr(descriptor_, &modes) != 0) {
    return;
  }
  input_modes_ = modes.c_iflag;
  modes.c_iflag &= ~static_cast<tcflag_t>(IXON);
  tcsetattr(descriptor_, TCSANOW, &modes);
}

NoFlowControl::~NoFlowControl() {
  termios modes{};
  if (input_modes_ && is_ours(descriptor_) && tcgetattr(descriptor_, &modes) == 0) {
    modes.c_iflag = *input_modes_;
    tcsetattr(descriptor_, TCSANOW, &modes);
  }
}
}  // namespace tapstudy::runner
