#include "runner/terminal/marked_text.hpp"

#include <string_view>
namespace tapstudy::runner {
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
}  // namespace tapstudy::runner
