#include "runner/terminal/operator_prompt.hpp"

#include <fmt/format.h>

#include "runner/terminal/say.hpp"
#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
bool asked_and_done(LineInput& input, TypedCommands& commands, const std::string& task,
                    const std::string& word) {
  const std::string how = word.empty() ? "press Enter" : fmt::format("type {}", word);
  say("{} {}. ", task, how);
  if (commands.obey_typed_ahead(input.forget_typed_ahead())) {
    return false;
  }
  while (const auto line = commands.next_of_participant(input, [] { return true; })) {
    if (*line == word) {
      return true;
    }
    if (asks_to_quit(*line)) {
      return false;
    }
    say("Type quit to stop here; or {}. ", how);
  }
  return false;
}
}  // namespace tapstudy::runner
