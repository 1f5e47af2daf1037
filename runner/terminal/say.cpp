#include "runner/terminal/say.hpp"

#include <cstdio>

#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
void write_to_terminal(const std::string& text) noexcept {
  if (std::fputs(text.c_str(), stderr) < 0 || std::fflush(stderr) != 0) {
    ask_to_stop();
  }
}
}  // namespace tapstudy::runner
