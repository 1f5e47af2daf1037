#pragma once
namespace tapstudy::runner {
// From here on Ctrl-C, a terminal that is closed, SIGTERM and SIGQUIT ask to stop instead of ending
// the process; a second one ends it.
void listen_for_stop();
bool stop_was_asked();
// Throws Stopped if so.
void stop_if_asked();
}  // namespace tapstudy::runner
