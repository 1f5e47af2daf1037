#pragma once
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "runner/terminal/line_input.hpp"
namespace tapstudy::runner {
// The operator's commands among the lines of a terminal at which a participant answers. The
// terminal does not wait until a command is stored: what became of it is said as soon as it is
// known.
class TypedCommands {
 public:
  struct Posted {
    std::string said;  // what is done
    std::shared_future<void> stored;
  };
  // Carries out a command, given without its colon; throws InvalidInput if it is impossible.
  using Post = std::function<Posted(const std::string& command)>;
  TypedCommands() = default;  // no session yet: no command is possible
  explicit TypedCommands(Post post) : post_{std::move(post)} {}

  // The next line that is not the operator's; nullopt as LineInput::next, and if the session is to
  // stop.
  std::optional<std::string> next_of_participant(LineInput& input,
                                                 const std::function<bool()>& keep_waiting);
  // Obeys what the operator typed ahead. Whether quit was typed.
  bool heed(const TypedAhead& typed);
  // Waits until every command was stored, or could not be.
  void finish();

 private:
  void obey(const std::string& line);
  void say_outcomes();
  Post post_;
  std::vector<Posted> open_;
};
}  // namespace tapstudy::runner
