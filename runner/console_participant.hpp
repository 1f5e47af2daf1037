#pragma once
#include <functional>

#include "runner/line_input.hpp"
#include "runner/participant.hpp"
namespace tapstudy::runner {
// A person at the terminal. Questions go to stderr, answers come from the input: the number of an
// answer in an identification; in a choice a label to feel that alternative and "= label" to
// choose it. "quit" or the end of the input stops the session.
class ConsoleParticipant final : public Participant {
 public:
  // move_hand is called before each trial; it sets a simulated hand tapping where there is no
  // device for the person to hold.
  ConsoleParticipant(LineInput& input, std::function<void()> move_hand)
      : input_{input}, move_hand_{std::move(move_hand)} {}
  void get_ready(const Presentation& presentation) override;
  std::optional<std::size_t> perform(const Presentation& presentation,
                                     Exploration& exploration) override;
  void saved(const Presentation& presentation) override;

 private:
  std::optional<std::string> next_line(const Exploration& exploration);
  std::optional<std::size_t> identify(const Presentation& presentation,
                                      const Exploration& exploration);
  std::optional<std::size_t> choose(const Presentation& presentation, Exploration& exploration);

  LineInput& input_;
  std::function<void()> move_hand_;
};
}  // namespace tapstudy::runner
