#pragma once
#include <future>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "protocols/protocol.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/rows.hpp"
#include "runner/session/participants/participant.hpp"
#include "runner/session/participants/trial_control.hpp"
namespace tapstudy::runner {
// What an operator can do during a session. The names are typed, and stored.
enum class OperatorAction {
  pause,
  resume,
  repeat,
  skip,
  correct,
  switch_to,
  note,
  end,
  exclude,
  include
};
enum class ActionText { none, optional, required };
struct ActionInfo {
  OperatorAction action;
  std::string_view name;
  ActionText text;
  std::string_view help;
};
std::span<const ActionInfo> operator_actions();
std::string_view name(OperatorAction action);

struct OperatorCommand {
  OperatorAction action{};
  std::string text{};
  std::optional<int> trial{};  // that is meant; refused if it is over
  results::GivenBy by{results::GivenBy::operator_of_session};
};
// "note the participant coughed", or with the trial that is meant, "skip @4 the string broke".
// Throws InvalidInput naming what is allowed.
OperatorCommand parse_operator_command(const std::string& line,
                                       std::span<const OperatorAction> offered = {});

struct TrialInView {
  protocols::PlannedTrial trial;
  TrialPrompt prompt;
  int attempt{};
};
struct AnswerInView {
  protocols::PlannedTrial trial;
  protocols::Answers answers;  // that could be given
  std::string response;        // as the task stores it
};

// unknown: the device did not confirm zero force.
enum class ForceState { off, on, unknown };

// The person who runs a session, as the trial engine sees them. This one wants nothing: nobody runs
// a simulated study.
class Operator {
 public:
  virtual ~Operator() = default;
  virtual void trial_begins(const TrialInView& /*trial*/) {}
  virtual void alternative_is_selected(std::size_t /*alternative*/) {}
  // carried_out: the request that ended it, if one did.
  virtual void trial_is_over(std::optional<TrialRequest> /*carried_out*/) {}
  virtual void force_is(ForceState /*force*/) {}
  // It is stored once its confidence is given, too.
  virtual void answer_is_given(int /*trial*/) {}
  virtual void answer_is_stored(const AnswerInView& /*answer*/) {}

  // The participant corrects the last answer, by a text that is one. Ready once that is stored, or
  // carries the StoreError; throws InvalidInput if there is nothing to correct.
  virtual std::shared_future<void> participant_corrects(const std::string& /*text*/) {
    throw core::InvalidInput{"there is nobody to correct an answer"};
  }

  virtual bool is_paused() const { return false; }
  virtual std::optional<TrialRequest> request() const { return {}; }  // for the running trial
  virtual std::optional<std::size_t> take_switch() { return {}; }     // to which alternative
  virtual std::string end_reason() const { return {}; }               // if the operator ended it
};
}  // namespace tapstudy::runner
