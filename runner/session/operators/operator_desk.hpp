#pragma once
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "results/store/recorder.hpp"
#include "runner/session/operators/operator.hpp"
#include "runner/terminal/operator_dialogue.hpp"
namespace tapstudy::runner {
// What a page or a terminal shows of it.
struct DeskView {
  struct Entry {
    results::OperatorActionRow row;
    bool is_stored{};
  };
  std::optional<TrialInView> trial;  // that is running
  std::size_t current{};             // its alternative that is felt
  std::optional<AnswerInView> last_answer;
  std::vector<Entry> log;
  ForceState force{ForceState::off};
  bool is_paused{};
  std::string held_by;      // why the operator is needed; empty: not
  std::string device_says;  // empty: nothing
  std::vector<OperatorAction> possible;
};

// Takes the operator's commands from any thread, stores each as a row, and hands what concerns the
// trial to the engine. Refuses what cannot be done now.
class OperatorDesk final : public Operator {
 public:
  struct Session {
    const protocols::Protocol& protocol;
    std::int64_t id;
    bool is_excluded;               // the participant, by an earlier session
    std::function<double()> now_s;  // as of its events
    // Told of each action as it is taken; may be empty.
    std::function<void(const results::OperatorActionRow&)> tell{};
  };
  OperatorDesk(Session session, results::Recorder& recorder)
      : session_{std::move(session)}, recorder_{recorder} {}

  // Any thread. Ready once the action is stored, or carries the StoreError. Throws InvalidInput if
  // it is impossible now: nothing is stored then.
  PostedCommand post(const OperatorCommand& command);
  // As the operator does, on the program's own account; nothing if paused already.
  void pause(const std::string& why);
  // Waits until the operator resumes; false if the session is to stop. `tell` is called once that
  // is possible.
  bool waits_for_operator(const std::string& why, const std::function<void()>& tell);
  DeskView view() const;
  // A device's own text for the operator; empty: nothing more.
  void device_says(const std::string& text);
  // A trial that is over, and may be remarked on.
  void trial_was(int number);

  void trial_begins(const TrialInView& trial) override;
  void alternative_is_selected(std::size_t alternative) override;
  void trial_is_over(std::optional<TrialRequest> carried_out) override;
  void force_is(ForceState force) override;
  void answer_is_given(int trial) override;
  void answer_is_stored(const AnswerInView& answer) override;
  std::shared_future<void> participant_corrects(const std::string& text) override;
  bool is_paused() const override;
  std::optional<TrialRequest> request() const override;
  std::optional<std::size_t> take_switch() override;
  std::string end_reason() const override;

 private:
  bool is_possible(OperatorAction action) const;
  void check_is_possible(const OperatorCommand& command) const;
  std::optional<int> trial_of(const OperatorCommand& command) const;
  bool is_excluded() const;
  std::string device_said() const;
  void apply(const OperatorCommand& command);
  std::string said_of(const OperatorCommand& command, const results::OperatorActionRow& row) const;
  results::CorrectionRow correction(const std::string& text, results::GivenBy by,
                                    std::string& detail) const;

  Session session_;
  results::Recorder& recorder_;
  mutable std::mutex mutex_;
  struct Logged {
    results::OperatorActionRow row;
    std::shared_future<void> stored;
  };
  std::vector<Logged> log_;
  std::optional<TrialInView> trial_;
  std::size_t current_{0};
  std::optional<AnswerInView> last_answer_;
  std::optional<int> last_trial_;
  std::optional<int> given_;  // the trial whose answer waits for its confidence
  std::optional<TrialRequest> request_;
  std::optional<std::size_t> switch_to_;
  std::string end_reason_;
  ForceState force_{ForceState::off};
  bool is_paused_{false};
  std::string held_by_;
  // By itself: who sets it holds the recorder, for which a command waits that holds the rest.
  mutable std::mutex device_mutex_;
  std::string device_says_;
};
}  // namespace tapstudy::runner
