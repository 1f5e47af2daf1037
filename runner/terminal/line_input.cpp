#include "runner/terminal/line_input.hpp"

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
namespace tapstudy::runner {
namespace {
constexpr int poll_ms = 20;
constexpr std::size_t max_line = 4096;
}  // namespace

std::optional<std::string> LineInput::take_line() {
  const auto end = received_.find('\n');
  if (end == std::string::npos) {
    return std::nullopt;
  }
  std::string line = received_.substr(0, end);
  received_.erase(0, end + 1);
  if (!line.empty() && line.back() == '\r') {
    line.pop_back();
  }
  return line;
}

void LineInput::forget_typed_ahead() {
  if (isatty(descriptor_) != 0) {
    tcflush(descriptor_, TCIFLUSH);
    received_.clear();
  }
}

std::optional<std::string> LineInput::next(const std::function<bool()>& keep_waiting) {
  while (keep_waiting()) {
    if (auto line = take_line()) {
      return line;
    }
    pollfd waiting{descriptor_, POLLIN, 0};
    if (poll(&waiting, 1, poll_ms) <= 0) {
      continue;
    }
    std::array<char, 512> bytes{};
    const ssize_t count = read(descriptor_, bytes.data(), bytes.size());
    if (count <= 0) {
      return std::nullopt;
    }
    received_.append(bytes.data(), static_cast<std::size_t>(count));
    if (received_.size() > max_line && received_.find('\n') == std::string::npos) {
      received_.clear();  // no answer is that long
    }
  }
  return std::nullopt;
}
}  // namespace tapstudy::runner
