#include "runner/terminal/operator_at_terminal.hpp"

#include <fmt/format.h>

#include <charconv>

#include "runner/terminal/exit_code.hpp"
#include "runner/terminal/operator_prompt.hpp"
#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
std::string OperatorAtTerminal::next_line() {
  const auto line = input_.next([] { return !stop_was_asked(); });
  if (!line || *line == "quit") {
    throw Stopped{"stopped; nothing was written"};
  }
  return *line;
}

void OperatorAtTerminal::please(const std::string& task) {
  if (!asked_and_done(input_, task + ", then")) {
    throw Stopped{"stopped; nothing was written"};
  }
}

double OperatorAtTerminal::how_much(const std::string& task, double max) {
  while (true) {
    fmt::print(stderr, "{}: ", task);
    const std::string line = next_line();
    double value = 0.0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
    if (error == std::errc{} && end == line.data() + line.size() && value > 0.0 && value <= max) {
      return value;
    }
    fmt::print(stderr, "  please type a number above 0, at most {}\n", max);
  }
}
}  // namespace tapstudy::runner
