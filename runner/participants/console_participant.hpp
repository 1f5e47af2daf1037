#pragma once
#include <functional>

#include "runner/participants/participant.hpp"
#include "runner/terminal/line_input.hpp"
namespace tapstudy::runner {
// A person at the terminal. Questions go to stderr, answers come from the input: the number of an
// answer; in trials with several alternatives, a label to feel that one and "= label" to choose it.
// "quit" or end of input stops the session.
class ConsoleParticipant final : public Participant {
 public:
  // move_hand is called before each trial; it starts the taps of a simulated hand if there is no
  // device for the person to hold.
  ConsoleParticipant(LineInput& input, std::function<void()> move_hand)
      : input_{input}, move_hand_{std::move(move_hand)} {}
  void get_ready(const TrialPrompt& prompt) override;
  std::optional<std::size_t> perform(const TrialPrompt& prompt, Exploration& exploration) override;
  void saved(const TrialPrompt& prompt) override;

 private:
  std::optional<std::string> next_line(const Exploration& exploration);
  std::optional<std::size_t> number_of_answer(const TrialPrompt& prompt,
                                              const Exploration& exploration);
  std::optional<std::size_t> chosen_alternative(const TrialPrompt& prompt,
                                                Exploration& exploration);

  LineInput& input_;
  std::function<void()> move_hand_;
};
}  // namespace tapstudy::runner
