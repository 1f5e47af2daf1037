#include "runner/terminal/say.hpp"

#include <unistd.h>

#include <cstdio>

#include "runner/terminal/stop_signal.hpp"
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
}  // namespace tapstudy::runner
