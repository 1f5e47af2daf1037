#pragma once
#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>
namespace tapstudy::runner {
// Writes to the terminal (standard error). Never throws for want of one: a terminal that has gone,
// or whose reader has, asks the session to stop, so that an open trial is stored first.
void write_to_terminal(const std::string& text) noexcept;

// Whether what is written is shown by a terminal.
bool is_shown_by_terminal() noexcept;

// What a participant must not read: away with what the screen shows, and with what was scrolled off
// it; nothing where it is no terminal.
void clear_screen() noexcept;

template <class... Parts>
void say(fmt::format_string<Parts...> format, Parts&&... parts) {
  write_to_terminal(fmt::format(format, std::forward<Parts>(parts)...));
}

// Text of a study for a terminal: "# " headings and **bold** without their marks, in bold where the
// terminal shows it (ECMA-48 SGR). Lists and paragraphs stay as they are written.
std::string marked_text(std::string_view text, bool shows_bold);

// While it lives, Ctrl-S and Ctrl-Q at the terminal do nothing: output stopped by Ctrl-S would hold
// up the thread that supervises a trial, and so end it. Has no effect on a file or pipe.
class NoFlowControl {
 public:
  explicit NoFlowControl(int descriptor);
  ~NoFlowControl();
  NoFlowControl(const NoFlowControl&) = delete;
  NoFlowControl& operator=(const NoFlowControl&) = delete;
  NoFlowControl(NoFlowControl&&) = delete;
  NoFlowControl& operator=(NoFlowControl&&) = delete;

 private:
  int descriptor_;
  std::optional<unsigned> input_modes_;  // as they were
};
}  // namespace tapstudy::runner
