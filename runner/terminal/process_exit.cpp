#include "runner/terminal/process_exit.hpp"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <csignal>
namespace tapstudy::runner {
namespace {
// A signal handler can only access globals.
std::atomic<bool> asked{false};  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
static_assert(std::atomic<bool>::is_always_lock_free);

void note(int /*signal*/) {
  asked.store(true);
}
}  // namespace

void listen_for_stop() {
  for (const int signal : std::array{SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    if (signal == SIGHUP && action.sa_handler == SIG_IGN) {
      continue;  // nohup
    }
    action = {};
    action.sa_handler = note;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigaction(signal, &action, nullptr);
  }
}

void ask_to_stop() noexcept {
  asked.store(true);
}

bool stop_was_asked() {
  return asked.load();
}

void stop_if_asked(std::string_view kept) {
  if (stop_was_asked()) {
    throw Stopped{fmt::format("stopped by the operator; {}", kept)};
  }
}
}  // namespace tapstudy::runner
