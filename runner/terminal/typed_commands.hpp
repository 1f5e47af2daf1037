#pragma once
#include <functional>
#include <optional>
#include <string>

#include "runner/terminal/line_input.hpp"
#include "runner/terminal/stored_outcomes.hpp"
namespace tapstudy::runner {
// The operator's commands among the lines of a terminal at which a participant answers. The
// terminal does not wait until a command is stored: what became of it is said as soon as it is
// known.
class TypedCommands {
 public:
  // Carries out a command, given without its colon; throws InvalidInput if it is impossible.
  using Post = std::function<PostedCommand(const std::string& command)>;
  TypedCommands() = default;  // no session yet: no command is possible
  explicit TypedCommands(Post post) : post_{std::move(post)} {}

  // The next line that is not the operator's; nullopt as LineInput::next, and if the session is to
  // stop.
  std::optional<std::string> next_of_participant(LineInput& input,
                                                 const std::function<bool()>& keep_waiting);
  // Obeys what the operator typed ahead. Whether quit was typed.
  bool obey_typed_ahead(const TypedAhead& typed);
  // Waits until every command was stored, or could not be.
  void finish() { outcomes_.finish(); }

 private:
  void obey(const std::string& line);
  Post post_;
  StoredOutcomes outcomes_{"  ", "> "};
};
}  // namespace tapstudy::runner
