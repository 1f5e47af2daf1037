#include "runner/terminal/operator_prompt.hpp"

#include <fmt/format.h>

#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
bool asked_and_done(LineInput& input, const std::string& task) {
  fmt::print(stderr, "{} press Enter. ", task);
  input.forget_typed_ahead();
  while (const auto line = input.next([] { return !stop_was_asked(); })) {
    if (line->empty()) {
      return true;
    }
    if (*line == "quit") {
      return false;
    }
    fmt::print(stderr, "Type quit to stop here; or press Enter. ");
  }
  return false;
}
}  // namespace tapstudy::runner
