#include "runner/terminal/typed_input.hpp"

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "core/text/plain_text.hpp"
namespace tapstudy::runner {
namespace {
constexpr int poll_ms = 20;
constexpr std::size_t max_line = 4096;
}  // namespace

bool asks_to_quit(const std::string& line) {
  std::string word;
  for (const char c : line) {
    if (std::isspace(static_cast<unsigned char>(c)) == 0) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return word == "quit";
}

bool is_of_operator(const std::string& line) {
  const auto first = line.find_first_not_of(" \t", 1);
  return line.starts_with(':') && first != std::string::npos &&
         std::isalpha(static_cast<unsigned char>(line[first])) != 0;
}

// The line that is too long is dropped whole: its tail would be taken for an answer.
std::optional<std::string> LineInput::take_line() {
  const auto end = received_.find('\n');
  if (end == std::string::npos) {
    is_too_long_ = is_too_long_ || received_.size() > max_line;
    if (is_too_long_) {
      received_.clear();
    }
    return std::nullopt;
  }
  std::string line = received_.substr(0, end);
  received_.erase(0, end + 1);
  if (std::exchange(is_too_long_, false) || line.size() > max_line) {
    return "(a line that is too long)";
  }
  if (!line.empty() && line.back() == '\r') {
    line.pop_back();
  }
  return line;
}

bool LineInput::is_terminal() const {
  return isatty(descriptor_) != 0;
}

// A terminal hands over whole lines only, except while it is not in canonical mode.
void LineInput::receive_unfinished_line() {
  termios by_line{};
  if (tcgetattr(descriptor_, &by_line) != 0) {
    return;
  }
  termios by_character = by_line;
  by_character.c_lflag &= ~static_cast<tcflag_t>(ICANON);
  by_character.c_cc[VMIN] = 0;
  by_character.c_cc[VTIME] = 0;
  tcsetattr(descriptor_, TCSANOW, &by_character);
  while (receive(0)) {
  }
  tcsetattr(descriptor_, TCSANOW, &by_line);
}

// An answer that was typed ahead is to a question that nobody had seen. Half a line of the
// operator's must not be dropped: its other half would be taken for an answer.
TypedAhead LineInput::forget_typed_ahead() {
  TypedAhead typed;
  if (!is_terminal()) {
    return typed;
  }
  while (receive(0)) {
  }
  receive_unfinished_line();
  while (auto line = take_line()) {
    typed.has_quit = typed.has_quit || asks_to_quit(*line);
    if (is_of_operator(*line)) {
      typed.of_operator.push_back(std::move(*line));
    }
  }
  if (!received_.starts_with(':')) {  // what else may become a command
    received_.clear();
  }
  return typed;
}

// Whether anything arrived within this time.
bool LineInput::receive(int time_out_ms) {
  pollfd waiting{descriptor_, POLLIN, 0};
  if (poll(&waiting, 1, time_out_ms) <= 0) {
    return false;
  }
  std::array<char, 512> bytes{};
  const ssize_t count = read(descriptor_, bytes.data(), bytes.size());
  has_ended_ = count <= 0;
  received_.append(bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  return !has_ended_;
}

// Of a script, whose last line need not end. What a person had begun to type when the terminal
// vanished is no answer.
std::optional<std::string> LineInput::rest() {
  if (received_.empty() || is_terminal()) {
    return std::nullopt;
  }
  received_ += '\n';
  return take_line();
}

std::optional<std::string> LineInput::next(const std::function<bool()>& keep_waiting) {
  while (keep_waiting()) {
    if (auto line = take_line()) {
      return line;
    }
    if (!receive(poll_ms) && has_ended_) {
      return rest();
    }
  }
  return std::nullopt;
}

std::optional<int> whole_number(std::string_view text, int low, int high) {
  const auto number = core::number_in<int>(text);
  return number && *number >= low && *number <= high ? number : std::nullopt;
}
}  // namespace tapstudy::runner
