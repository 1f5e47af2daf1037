#pragma once
#include <functional>
#include <optional>
#include <string>
namespace tapstudy::runner {
// Reads lines from a file descriptor (a terminal, a pipe) while polling for other events:
// keep_waiting is called many times a second.
class LineInput {
 public:
  explicit LineInput(int descriptor) : descriptor_{descriptor} {}
  // nullopt at end of input or when keep_waiting returns false.
  std::optional<std::string> next(const std::function<bool()>& keep_waiting);
  // Discards a terminal's type-ahead. Has no effect on a file or pipe.
  void forget_typed_ahead();

 private:
  std::optional<std::string> take_line();
  int descriptor_;
  std::string received_;
};
}  // namespace tapstudy::runner
