#include "runner/terminal/terminal_output.hpp"

#include <termios.h>
#include <unistd.h>

#include <cstdio>
#include <string_view>

#include "runner/terminal/process_exit.hpp"
namespace tapstudy::runner {
void write_to_terminal(const std::string& text) noexcept {
  if (std::fputs(text.c_str(), stderr) < 0 || std::fflush(stderr) != 0) {
    ask_to_stop();
  }
}

bool is_shown_by_terminal() noexcept {
  return isatty(STDERR_FILENO) == 1;
}

void clear_screen() noexcept {
  if (is_shown_by_terminal()) {
    write_to_terminal("\033[H\033[2J\033[3J");
  }
}

namespace {
std::string bold(std::string_view words, bool is_shown) {
  return is_shown ? "\033[1m" + std::string{words} + "\033[0m" : std::string{words};
}

std::string marked_line(std::string_view line, bool shows_bold) {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first != std::string_view::npos && line.substr(first).starts_with("# ")) {
    return bold(line.substr(first + 2), shows_bold);
  }
  std::string shown;
  while (true) {
    const std::size_t begin = line.find("**");
    // As on the page, something stands between the marks.
    const std::size_t end = begin == std::string_view::npos ? begin : line.find("**", begin + 3);
    if (end == std::string_view::npos) {
      return shown.append(line);
    }
    shown += line.substr(0, begin);
    shown += bold(line.substr(begin + 2, end - begin - 2), shows_bold);
    line.remove_prefix(end + 2);
  }
}
}  // namespace

std::string marked_text(std::string_view text, bool shows_bold) {
  std::string shown;
  while (true) {
    const std::size_t end = text.find('\n');
    shown += marked_line(text.substr(0, end), shows_bold);
    if (end == std::string_view::npos) {
      return shown;
    }
    shown += '\n';
    text.remove_prefix(end + 1);
  }
}

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
