#pragma once
#include <string_view>
namespace tapstudy::runner {
// Installs handlers: Ctrl-C, a closed terminal, SIGTERM and SIGQUIT request a stop instead of
// ending the process; a second one ends it.
void listen_for_stop();
// Requests a stop from within.
void ask_to_stop() noexcept;
bool stop_was_asked();
// Throws Stopped if a stop was requested, with what is kept.
void stop_if_asked(std::string_view kept = "every answer given so far is kept");
}  // namespace tapstudy::runner
