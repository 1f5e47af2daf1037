#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
namespace tapstudy::runner {
// Whether a line is the word quit.
bool asks_to_quit(const std::string& line);
// Where a participant answers at the terminal, a line of a colon and a word is the operator's;
// ":-)" is the participant's.
bool is_of_operator(const std::string& line);

// What was typed before a question was asked.
struct TypedAhead {
  bool has_quit{};
  std::vector<std::string> of_operator;  // with the colon
};

// Reads lines from a file descriptor (a terminal, a pipe) while polling for other events:
// keep_waiting is called many times a second.
class LineInput {
 public:
  explicit LineInput(int descriptor) : descriptor_{descriptor} {}
  // nullopt at end of input or when keep_waiting returns false.
  std::optional<std::string> next(const std::function<bool()>& keep_waiting);
  bool is_terminal() const;  // or a file or pipe: a script
  // Discards the participant's type-ahead at a terminal. The operator's lines are returned, and one
  // that is still being typed is kept. Has no effect on a file or pipe.
  [[nodiscard]] TypedAhead forget_typed_ahead();

 private:
  std::optional<std::string> take_line();
  std::optional<std::string> rest();
  bool receive(int time_out_ms);
  void receive_unfinished_line();
  int descriptor_;
  std::string received_;
  bool is_too_long_{false};
  bool has_ended_{false};
};

// The text as a whole number, if it is one and nothing else, from low to high.
std::optional<int> whole_number(std::string_view text, int low, int high);
}  // namespace tapstudy::runner
