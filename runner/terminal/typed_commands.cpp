#include "runner/terminal/typed_commands.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "runner/terminal/say.hpp"
#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
void TypedCommands::obey(const std::string& line) {
  if (!post_) {
    say("  no session has begun yet: {} is not possible\n", line);
    return;
  }
  try {
    outcomes_.add(post_(line.substr(1)));
  } catch (const core::InvalidInput& error) {
    say("  {}\n> ", error.what());
  }
}

bool TypedCommands::obey_typed_ahead(const TypedAhead& typed) {
  std::ranges::for_each(typed.of_operator, [this](const std::string& line) { obey(line); });
  return typed.has_quit;
}

std::optional<std::string> TypedCommands::next_of_participant(
    LineInput& input, const std::function<bool()>& keep_waiting) {
  const auto waits = [&] {
    outcomes_.say_known();
    return keep_waiting() && !stop_was_asked();
  };
  while (auto line = input.next(waits)) {
    if (!is_of_operator(*line)) {
      return line;
    }
    obey(*line);
  }
  return std::nullopt;
}
}  // namespace tapstudy::runner
