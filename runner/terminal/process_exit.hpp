#pragma once
#include <stdexcept>
#include <string_view>
namespace tapstudy::runner {
// Exit status of the process.
enum class ExitCode {
  done = 0,
  internal_error = 1,  // a defect of the program, or not enough memory
  wrong_input = 2,
  device_failed = 3,
  model_failed = 4,
  store_failed = 5,
  stopped = 130
};

// The operator asked to stop (Ctrl-C, end of input); all answers are kept.
class Stopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A participant did not get through practice, without which the protocol lets nobody go on.
class PracticeMissed : public Stopped {
 public:
  using Stopped::Stopped;
};

// A participant gave an answer that ends the session, as the protocol says: which.
class TookNoPart : public Stopped {
 public:
  using Stopped::Stopped;
};

// Installs handlers: Ctrl-C, a closed terminal, SIGTERM and SIGQUIT request a stop instead of
// ending the process; a second one ends it.
void listen_for_stop();
// Requests a stop from within.
void ask_to_stop() noexcept;
bool stop_was_asked();
// Throws Stopped if a stop was requested, with what is kept.
void stop_if_asked(std::string_view kept = "every answer given so far is kept");
}  // namespace tapstudy::runner
