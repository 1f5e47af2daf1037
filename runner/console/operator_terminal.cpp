#include "runner/console/operator_terminal.hpp"

#include "core/error.hpp"
#include "runner/terminal/say.hpp"
#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
OperatorTerminal::OperatorTerminal(LineInput& input, OperatorDesk& desk, const ConsoleApi& shown)
    : input_{input}, desk_{desk}, shown_{shown}, thread_{[this](const std::stop_token& stop) {
        run(stop);
        outcomes_.finish();
      }} {}

// At the end of input the session goes on: a page may have an operator, too.
void OperatorTerminal::run(const std::stop_token& stop) {
  while (const auto line = input_.next([&] {
    outcomes_.say_known();
    show_if_watched();
    return !stop.stop_requested() && !stop_was_asked();
  })) {
    if (asks_to_quit(*line)) {
      ask_to_stop();
      return;
    }
    is_watched_ = false;
    if (!line->empty()) {
      obey(*line);
    }
  }
}

void OperatorTerminal::show_if_watched() {
  constexpr std::chrono::seconds interval{1};
  const auto now = std::chrono::steady_clock::now();
  if (is_watched_ && now - shown_at_ >= interval) {
    shown_at_ = now;
    write_to_terminal(shown_.live(shown_steps_));
  }
}

void OperatorTerminal::obey(const std::string& line) {
  const bool is_watch = line == "watch";
  if (is_watch || line == "status") {
    write_to_terminal(shown_.status());
    is_watched_ = is_watch;
  } else {
    order(line);
  }
}

void OperatorTerminal::order(const std::string& command) {
  try {
    outcomes_.add(desk_.post(parse_operator_command(command)));
    outcomes_.say_known();
  } catch (const core::InvalidInput& error) {
    say("{}; status and watch show what the session does\n", error.what());
  } catch (const std::exception& error) {  // none may leave a thread
    say("not stored: {}\n", error.what());
  }
}
}  // namespace tapstudy::runner
