#pragma once
#include <functional>
#include <optional>
#include <string>
namespace tapstudy::runner {
// Lines from a file descriptor (a terminal, a pipe), waiting for them without missing anything else
// that happens: keep_waiting is asked many times a second.
class LineInput {
 public:
  explicit LineInput(int descriptor) : descriptor_{descriptor} {}
  // Nothing at the end of the input or when keep_waiting says no.
  std::optional<std::string> next(const std::function<bool()>& keep_waiting);
  // What a person typed before being asked. A file or another program does not type ahead.
  void forget_typed_ahead();

 private:
  std::optional<std::string> take_line();
  int descriptor_;
  std::string received_;
};
}  // namespace tapstudy::runner
