#include "runner/console/operator_terminal.hpp"

#include "core/error.hpp"
#include "runner/terminal/say.hpp"
#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
OperatorTerminal::OperatorTerminal(LineInput& input, OperatorDesk& desk)
    : input_{input}, desk_{desk}, thread_{[this](const std::stop_token& stop) { run(stop); }} {}

// At the end of input the session goes on: a page may have an operator, too.
void OperatorTerminal::run(const std::stop_token& stop) {
  while (const auto line =
             input_.next([&] { return !stop.stop_requested() && !stop_was_asked(); })) {
    if (asks_to_quit(*line)) {
      ask_to_stop();
      return;
    }
    if (!line->empty()) {
      obey(*line);
    }
  }
}

void OperatorTerminal::obey(const std::string& line) {
  try {
    const OperatorDesk::Posted posted = desk_.post(parse_operator_command(line));
    posted.stored.get();
    say("stored: {}\n", posted.said);
  } catch (const core::InvalidInput& error) {
    say("{}\n", error.what());
  } catch (const std::exception& error) {  // none may leave a thread
    say("not stored: {}\n", error.what());
  }
}
}  // namespace tapstudy::runner
