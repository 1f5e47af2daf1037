#pragma once
#include <fmt/format.h>

#include <string>
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
}  // namespace tapstudy::runner
