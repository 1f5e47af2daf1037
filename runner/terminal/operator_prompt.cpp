#include "runner/terminal/operator_prompt.hpp"

#include "runner/terminal/say.hpp"
#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
bool asked_and_done(LineInput& input, const std::string& task) {
  say("{} press Enter. ", task);
  if (input.forget_typed_ahead()) {
    return false;
  }
  while (const auto line = input.next([] { return !stop_was_asked(); })) {
    if (line->empty()) {
      return true;
    }
    if (asks_to_quit(*line)) {
      return false;
    }
    say("Type quit to stop here; or press Enter. ");
  }
  return false;
}
}  // namespace tapstudy::runner
