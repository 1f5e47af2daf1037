#include "runner/terminal/operator_at_terminal.hpp"

#include "core/number_in.hpp"
#include "runner/terminal/exit_code.hpp"
#include "runner/terminal/operator_prompt.hpp"
#include "runner/terminal/say.hpp"
#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
std::string OperatorAtTerminal::next_line(const std::function<void()>& keep_waiting) {
  const auto line = input_.next([&] {
    keep_waiting();
    return !stop_was_asked();
  });
  if (!line || asks_to_quit(*line)) {
    throw Stopped{"stopped; nothing was written"};
  }
  return *line;
}

void OperatorAtTerminal::please(const std::string& task) {
  if (!asked_and_done(input_, commands_, task + ", then")) {
    throw Stopped{"stopped; nothing was written"};
  }
}

void OperatorAtTerminal::warn(const std::string& what) noexcept {
  write_to_terminal("\n" + what + "\n");
}

double OperatorAtTerminal::how_much(const std::string& task, double max,
                                    const std::function<void()>& keep_waiting) {
  while (true) {
    say("{}: ", task);
    const std::string line = next_line(keep_waiting);
    const auto value = core::number_in<double>(line);
    if (value && *value > 0.0 && *value <= max) {
      return *value;
    }
    say("  please type a number above 0, at most {}\n", max);
  }
}
}  // namespace tapstudy::runner
