#pragma once
#include <chrono>
#include <functional>

#include "runner/session/participants/participant.hpp"
#include "runner/session/participants/terminal_trial.hpp"
#include "runner/terminal/operator_dialogue.hpp"
#include "runner/terminal/typed_input.hpp"
namespace tapstudy::runner {
// A person at the terminal. Questions go to stderr, answers come from the input: an answer as
// protocols::answer_in takes it; in trials with several alternatives, a label to feel that one and
// "= label" to choose it; where the last of them is set, "+" and "-" move it and "=" answers; where
// they come one after the other, "again" replays them.
// "quit" or end of input stops the session; a line that begins with a colon is the operator's.
class TerminalParticipant final : public Participant {
 public:
  // move_hand is called before each trial; it starts the taps of a simulated hand if there is no
  // device for the person to hold.
  TerminalParticipant(LineInput& input, TypedCommands& commands, std::function<void()> move_hand)
      : input_{input}, commands_{commands}, move_hand_{std::move(move_hand)} {}
  void read(const std::string& instructions,
            const std::optional<protocols::Picture>& picture) override;
  void practice_is_over() override;
  void rest(const protocols::Breaks& breaks) override;
  bool fills_in_forms() const override { return true; }
  protocols::FormAnswers fill_in(const protocols::Form& form) override;
  void wait_while(const std::function<bool()>& is_paused) override;
  void get_ready(const TrialPrompt& prompt) override;
  std::optional<std::string> perform(const TrialPrompt& prompt, TrialControl& control) override;
  std::optional<int> confidence(const protocols::Confidence& scale) override;
  void feedback(bool is_correct, const std::string& right_label) override;
  void saved(const TrialPrompt& prompt) override;
  bool saves_again(const std::string& cause) override;
  void repeats(const TrialPrompt& prompt) override;
  void skipped(const TrialPrompt& prompt) override;
  void refused(const TrialPrompt& prompt, const TooEarly& why) override;
  void timed_out(const TrialPrompt& prompt, bool is_presented_again) override;

 private:
  void wait_until(std::chrono::steady_clock::time_point earliest);
  void wait_for_enter(
      std::chrono::steady_clock::time_point latest = std::chrono::steady_clock::time_point::max());
  void say_picture(const std::optional<protocols::Picture>& picture);
  std::string answer_to(const protocols::FormItem& item);
  // The participant's next line; the operator's are obeyed.
  std::optional<std::string> next_of_participant(const std::function<bool()>& keep_waiting);
  // The participant's type-ahead is dropped, the operator's obeyed; whether quit was typed.
  bool forget_typed_ahead();
  // A script cannot be asked to tap first: its next line waits until the plate was touched.
  void let_script_wait(const TrialPrompt& prompt, std::size_t alternative,
                       TrialControl& control) const;
  // A script's next line also waits until all intervals are over.
  void wait_for_intervals(const TrialPrompt& prompt, TrialControl& control);
  bool passes_time_until(const std::function<bool()>& is_done, TrialControl& control) const;
  std::optional<std::string> next_line(const TrialPrompt& prompt, TrialControl& control);
  // "correct 2": whether the word was that.
  bool corrects(const std::string& line, const TrialPrompt& prompt, TrialControl& control) const;
  // "++", "-": whether the line was that.
  bool adjusts(const std::string& line, const TrialPrompt& prompt, TrialControl& control) const;
  std::optional<std::string> answer_by_itself(const TrialPrompt& prompt, TrialControl& control);
  std::optional<std::string> answer_among_alternatives(const TrialPrompt& prompt,
                                                       TrialControl& control);

  LineInput& input_;
  TypedCommands& commands_;
  std::function<void()> move_hand_;
  std::optional<TypedIntervals> intervals_;  // of the trial
  std::optional<TypedCountdown> countdown_;  // likewise
};
}  // namespace tapstudy::runner
