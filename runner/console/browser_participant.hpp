#pragma once
#include <chrono>
#include <functional>
#include <optional>

#include "runner/console/screen.hpp"
#include "runner/session/participants/participant.hpp"
namespace tapstudy::runner {
// A person at the participant's page.
class BrowserParticipant final : public Participant {
 public:
  struct Context {
    std::function<void()> move_hand;  // as a TerminalParticipant's
    // What is drawn while an alternative of the trial that is shown can be felt.
    std::function<std::optional<int>(std::size_t alternative)> scene;
    // Tells the operator; whether to try again.
    std::function<bool(const std::string& cause)> ask_operator;
    std::function<void(const std::string& why)> pause;  // as the operator does
  };
  BrowserParticipant(ScreenExchange& screens, Context context)
      : screens_{screens}, context_{std::move(context)} {}
  void read(const std::string& instructions,
            const std::optional<protocols::Picture>& picture) override;
  void practice_is_over() override;
  void rest(const protocols::Breaks& breaks) override;
  bool fills_in_forms() const override { return true; }
  protocols::FormAnswers fill_in(const protocols::Form& form) override;
  void wait_while(const std::function<bool()>& is_paused) override;
  void arrive() override;
  void get_ready(const TrialPrompt& prompt) override;
  std::optional<std::string> perform(const TrialPrompt& prompt, TrialControl& control) override;
  std::optional<int> confidence(const protocols::Confidence& scale) override;
  void feedback(bool is_correct, const std::string& right_label) override;
  void refused(const TrialPrompt& prompt, const TooEarly& why) override;
  void timed_out(const TrialPrompt& prompt, bool is_presented_again) override;
  bool saves_again(const std::string& cause) override;
  void repeats(const TrialPrompt& prompt) override;
  void plate_is_changed() override;
  void interrupted() override;
  void skipped(const TrialPrompt& prompt) override;
  void saved(const TrialPrompt& prompt) override;

 private:
  std::int64_t show(Screen screen);
  std::int64_t show_trial(const TrialPrompt& prompt, const TrialControl& control);
  // Until it is answered; throws Stopped if the session is to stop.
  ScreenInput answer_to(Screen screen);
  // nullopt: it was not, until then.
  std::optional<ScreenInput> answer_before(std::chrono::steady_clock::time_point latest,
                                           Screen screen);
  void tell(Message message);
  void tell_entered(const TrialPrompt& prompt, TrialControl& control);
  void act_on(const ScreenInput& input, const TrialPrompt& prompt, TrialControl& control);
  std::optional<std::string> last_word(const TrialPrompt& prompt, TrialControl& control);
  void pause_if_page_silent();
  // Whether there is something new to show of it.
  bool follow_correction();

  ScreenExchange& screens_;
  Context context_;
  std::optional<TrialProgress> progress_;
  std::optional<TooEarly> notice_;
  std::shared_future<void> correction_;  // that is being stored
  CorrectionState correction_state_{CorrectionState::none};
  std::chrono::steady_clock::time_point asked_at_;  // whether somebody is there
};
}  // namespace tapstudy::runner
