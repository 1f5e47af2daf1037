#pragma once
#include <functional>
#include <optional>
#include <string>
namespace tapstudy::runner {
// Whether a line is the word quit.
bool asks_to_quit(const std::string& line);

// Reads lines from a file descriptor (a terminal, a pipe) while polling for other events:
// keep_waiting is called many times a second.
class LineInput {
 public:
  explicit LineInput(int descriptor) : descriptor_{descriptor} {}
  // nullopt at end of input or when keep_waiting returns false.
  std::optional<std::string> next(const std::function<bool()>& keep_waiting);
  bool is_terminal() const;  // or a file or pipe: a script
  // Discards a terminal's type-ahead; whether "quit" was in it. Has no effect on a file or pipe.
  [[nodiscard]] bool forget_typed_ahead();

 private:
  std::optional<std::string> take_line();
  bool receive(int time_out_ms);
  int descriptor_;
  std::string received_;
  bool is_too_long_{false};
  bool has_ended_{false};
};
}  // namespace tapstudy::runner
