#pragma once
#include <chrono>
#include <functional>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
namespace tapstudy::runner {
class TrialControl;

// How far a participant is: of the practice while it lasts, then of the trials that count.
struct TrialProgress {
  int done{};  // and need not come again
  int total{};
  bool is_practice{};
  bool is_open_ended{};            // total is the most there can be: procedures may end before
  double elapsed_s{};              // of the session
  std::optional<double> left_s{};  // of all its trials, at the pace so far; unset: not known
};

// Of the trial that is presented: "3 of 8", or "3" where nobody knows of how many.
std::string place_in(const TrialProgress& progress);

// A trial as presented to the participant. Does not disclose the rendered stimulus.
struct TrialPrompt {
  int number{};
  int total{};  // of the session
  TrialProgress progress{};
  const protocols::Block* block{};
  protocols::Answers answers;  // the allowed ones
  std::vector<std::string>
      alternative_labels;  // to switch among; empty: there is nothing to switch
  // The alternative that an answer names, or that all answers are about; nullopt: none, as "same".
  std::optional<std::size_t> alternative_of(const std::string& answer) const;
  bool answers_name_alternatives() const;
  // The participant's last answer, where it may still be corrected.
  struct Previous {
    protocols::Answers answers;
    // Takes a text that is an answer. Ready once the correction is stored, or carries the
    // StoreError.
    std::function<std::shared_future<void>(const std::string& text)> correct;
  };
  std::optional<Previous> previous{};
};

// When a rest that begins now may end, and when it does by itself.
struct RestTimes {
  std::chrono::steady_clock::time_point earliest;
  std::chrono::steady_clock::time_point latest;
};
RestTimes rest_times(const protocols::Breaks& breaks);

// Why an answer would be too early.
struct TooEarly {
  enum class Reason {
    intervals,
    plate_untouched,
    alternatives_untouched,
    plate_unfelt,         // untouched where taps are scripted
    alternatives_unfelt,  // likewise
    time
  };
  Reason reason{};
  int min_contacts{};
  std::vector<std::string> labels{};  // of the alternatives to touch
  double min_seconds{};
};
std::string to_text(const TooEarly& too_early);

// A participant: a person at the terminal, or a simulation.
class Participant {
 public:
  virtual ~Participant() = default;
  // Between trials; each returns once the participant goes on, and throws Stopped where none does.
  virtual void read(const std::string& /*instructions*/,
                    const std::optional<protocols::Picture>& /*picture*/) {}
  virtual void practice_is_over() {}
  virtual void rest(const protocols::Breaks& /*breaks*/) {}
  // A simulation has nothing to say about itself.
  virtual bool fills_in_forms() const { return false; }
  // To the items that are asked (asked_items); each is an answer of its kind.
  virtual protocols::FormAnswers fill_in(const protocols::Form& /*form*/) { return {}; }
  // The operator's pause, until is_paused is false.
  virtual void wait_while(const std::function<bool()>& /*is_paused*/) {}
  // Returns once somebody is there to answer.
  virtual void arrive() {}
  // Before the trial's loop starts.
  virtual void get_ready(const TrialPrompt& /*prompt*/) {}
  // Explores and answers: one of the prompt's answers, or nullopt if the trial could not be
  // finished.
  virtual std::optional<std::string> perform(const TrialPrompt& prompt, TrialControl& control) = 0;
  // How sure the participant is of the answer just given; nullopt if that is not said.
  virtual std::optional<int> confidence(const protocols::Confidence& /*scale*/) { return {}; }
  // Which answer was right.
  virtual void feedback(bool /*is_correct*/, const std::string& /*right_label*/) {}
  // Called before a real plate is mounted.
  virtual void plate_is_changed() {}
  // Called where the device has failed, before the operator sees to it.
  virtual void interrupted() {}
  // Called where the operator ended the trial without an answer.
  virtual void skipped(const TrialPrompt& /*prompt*/) {}
  // Called where the answer came too early: why. perform is called again.
  virtual void refused(const TrialPrompt& /*prompt*/, const TooEarly& /*why*/) {}
  // Called where the trial took too long; whether it is presented again later.
  virtual void timed_out(const TrialPrompt& /*prompt*/, bool /*is_presented_again*/) {}
  // Called where the trial cannot be stored: whether to try again, once somebody has seen to it.
  virtual bool saves_again(const std::string& /*cause*/) { return false; }
  // Called once the answer is stored.
  virtual void saved(const TrialPrompt& /*prompt*/) {}
  // Called instead where the answer does not count and the trial is presented again.
  virtual void repeats(const TrialPrompt& /*prompt*/) {}
};
}  // namespace tapstudy::runner
