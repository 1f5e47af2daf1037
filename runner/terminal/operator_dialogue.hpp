#pragma once
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "device/spidar/calibration_procedure.hpp"
#include "runner/terminal/typed_input.hpp"
namespace tapstudy::runner {
// An operator's command that was carried out, and its record on the way to the disk.
struct PostedCommand {
  std::string said;  // what is done
  std::shared_future<void> stored;
};

// Says of each command whether it is stored, once that is known: nobody who types waits for a disk.
class StoredOutcomes {
 public:
  // Both written around each outcome.
  StoredOutcomes(std::string indent, std::string prompt)
      : indent_{std::move(indent)}, prompt_{std::move(prompt)} {}
  void add(PostedCommand command) { open_.push_back(std::move(command)); }
  void say_known();
  // Waits until every command was stored, or could not be.
  void finish();

 private:
  void say_outcome(const PostedCommand& command) const;
  std::string indent_;
  std::string prompt_;
  std::vector<PostedCommand> open_;
};

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

// Asks the person at the terminal to do something and then type `word`; empty: to press Enter.
// Type-ahead is discarded, except for the operator's lines, which go to `commands`.
// False if the person typed quit, asked to stop, or the input ended.
bool asked_and_done(LineInput& input, TypedCommands& commands, const std::string& task,
                    const std::string& word = "");

// The operator at the terminal: tasks go to stderr, measured values come from the input.
// Throws Stopped at end of input or when the operator asks to stop.
class OperatorAtTerminal final : public device::CalibrationOperator {
 public:
  explicit OperatorAtTerminal(LineInput& input) : input_{input} {}
  void please(const std::string& task) override;
  double how_much(const std::string& task, double max,
                  const std::function<void()>& keep_waiting) override;
  void warn(const std::string& what) noexcept override;

 private:
  std::string next_line(const std::function<void()>& keep_waiting);
  LineInput& input_;
  TypedCommands commands_;  // none: no session is running
};
}  // namespace tapstudy::runner
