#include "runner/session/operators/operator_desk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "core/error.hpp"
#include "runner/terminal/process_exit.hpp"
#include "runner/terminal/typed_input.hpp"
namespace tapstudy::runner {
namespace {
// From 1, as people count. Throws InvalidInput if there are fewer.
std::size_t number_up_to(std::size_t most, const std::string& text) {
  const std::optional<int> number = whole_number(text, 1, static_cast<int>(most));
  if (!number) {
    throw core::InvalidInput{fmt::format("'{}' is not a number from 1 to {}", text, most)};
  }
  return static_cast<std::size_t>(*number - 1);
}

std::string answer_of(const std::string& text, const protocols::Answers& answers) {
  const std::optional<std::string> answer = answer_in(text, answers);
  if (!answer) {
    throw core::InvalidInput{fmt::format("'{}' is not {}", text, expected_answer(answers))};
  }
  return *answer;
}

}  // namespace

bool OperatorDesk::is_possible(OperatorAction action) const {
  switch (action) {
    case OperatorAction::pause:
      return !is_paused_;
    case OperatorAction::resume:
      return is_paused_;
    case OperatorAction::repeat:
    case OperatorAction::skip:
      return trial_ && !is_paused_ && !request_;
    case OperatorAction::switch_to:
      return trial_ && trial_->prompt.alternative_labels.size() > 1;
    case OperatorAction::correct:
      return last_answer_.has_value();
    case OperatorAction::exclude:
      return !is_excluded();
    case OperatorAction::include:
      return is_excluded();
    case OperatorAction::note:
    case OperatorAction::end:
      return true;
  }
  return false;
}

void OperatorDesk::check_is_possible(const OperatorCommand& command) const {
  if (!is_possible(command.action)) {
    throw core::InvalidInput{fmt::format("{} is not possible now", name(command.action))};
  }
  const std::optional<int> trial = trial_of(command);
  if (command.action == OperatorAction::correct && given_ &&
      command.trial.value_or(*given_) == *given_) {
    throw core::InvalidInput{fmt::format(
        "the answer of trial {} is stored, and can be corrected, once its confidence is given{}",
        *given_, trial ? fmt::format(" (the one before: correct @{} …)", *trial) : "")};
  }
  if (command.trial && command.trial != trial) {
    throw core::InvalidInput{fmt::format("trial {} is over", *command.trial)};
  }
  if (command.action == OperatorAction::switch_to) {
    number_up_to(trial_->prompt.alternative_labels.size(), command.text);
    if (trial_->prompt.block->explore.intervals) {
      throw core::InvalidInput{"the alternatives are presented in sequence automatically"};
    }
  }
}

// A remark may be about the last trial, too.
std::optional<int> OperatorDesk::trial_of(const OperatorCommand& command) const {
  if (command.action == OperatorAction::correct) {
    return last_answer_->trial.number;
  }
  if (command.action == OperatorAction::note && last_trial_ && command.trial == last_trial_) {
    return last_trial_;
  }
  return trial_ ? std::optional{trial_->trial.number} : std::nullopt;
}

results::CorrectionRow OperatorDesk::correction(const std::string& text, results::GivenBy by,
                                                std::string& detail) const {
  const protocols::PlannedTrial& trial = last_answer_->trial;
  const std::string answer = answer_of(text, last_answer_->answers);
  results::CorrectionRow row;
  row.session_id = session_.id;
  row.number = trial.number;
  row.response = trial.task->response(trial, session_.protocol.block(trial.block), answer);
  row.is_correct =
      trial.task->is_correct(trial, session_.protocol.block(trial.block), row.response);
  row.given_by = by;
  detail = row.response;
  return row;
}

// What the engine asks about.
void OperatorDesk::apply(const OperatorCommand& command) {
  switch (command.action) {
    case OperatorAction::pause:
    case OperatorAction::resume:
      is_paused_ = command.action == OperatorAction::pause;
      break;
    case OperatorAction::repeat:
      request_ = TrialRequest::repeat;
      break;
    case OperatorAction::skip:
      request_ = TrialRequest::skip;
      break;
    case OperatorAction::switch_to:
      switch_to_ = number_up_to(trial_->prompt.alternative_labels.size(), command.text);
      break;
    case OperatorAction::end:
      end_reason_ = command.text;
      ask_to_stop();
      break;
    case OperatorAction::exclude:
    case OperatorAction::include:
    case OperatorAction::correct:
    case OperatorAction::note:
      break;
  }
}

// A participant may read it too: an answer by its label, which may be blind.
std::string OperatorDesk::said_of(const OperatorCommand& command,
                                  const results::OperatorActionRow& row) const {
  return command.action == OperatorAction::correct
             ? label_of_answer(answer_of(command.text, last_answer_->answers),
                               last_answer_->answers)
             : row.detail;
}

PostedCommand OperatorDesk::post(const OperatorCommand& command) {
  const std::lock_guard lock{mutex_};
  check_is_possible(command);
  results::OperatorActionRow row{session_.id, session_.now_s(), std::string{name(command.action)},
                                 trial_of(command), command.text};
  std::shared_future<void> stored;
  if (command.action == OperatorAction::correct) {
    results::CorrectionRow corrected = correction(command.text, command.by, row.detail);
    stored = recorder_.correct(std::move(corrected), row).share();
  } else {
    stored = recorder_.note(row).share();
  }
  if (session_.tell) {
    session_.tell(row);
  }
  apply(command);
  const std::string text = said_of(command, row);
  std::string said =
      fmt::format("{}{}{}", row.action, row.number ? fmt::format(", trial {}", *row.number) : "",
                  text.empty() ? "" : ": " + text);
  log_.push_back({std::move(row), stored});
  return {std::move(said), stored};
}

void OperatorDesk::pause(const std::string& why) {
  try {
    post({OperatorAction::pause, why});
  } catch (const core::InvalidInput&) {  // NOLINT(bugprone-empty-catch): it is paused
  }
}

bool OperatorDesk::waits_for_operator(const std::string& why, const std::function<void()>& tell) {
  const auto held_by = [&](const std::string& cause) {
    const std::lock_guard lock{mutex_};
    held_by_ = cause;
    is_paused_ = is_paused_ || !cause.empty();  // a pause since the resume stays one
  };
  held_by(why);
  tell();
  while (is_paused() && !stop_was_asked()) {
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  held_by("");
  return !stop_was_asked();
}

void OperatorDesk::trial_was(int number) {
  const std::lock_guard lock{mutex_};
  last_trial_ = number;
}

void OperatorDesk::trial_begins(const TrialInView& trial) {
  const std::lock_guard lock{mutex_};
  given_.reset();
  trial_ = trial;
  current_ = 0;
}

void OperatorDesk::alternative_is_selected(std::size_t alternative) {
  const std::lock_guard lock{mutex_};
  current_ = alternative;
}

// The answer may have come in the moment before.
void OperatorDesk::trial_is_over(std::optional<TrialRequest> carried_out) {
  const std::lock_guard lock{mutex_};
  if (request_ && !carried_out) {
    const OperatorAction action =
        *request_ == TrialRequest::skip ? OperatorAction::skip : OperatorAction::repeat;
    results::OperatorActionRow row{
        session_.id, session_.now_s(), std::string{name(OperatorAction::note)},
        trial_->trial.number, fmt::format("{}: not carried out, the trial was over", name(action))};
    const std::shared_future<void> stored = recorder_.note(row).share();
    log_.push_back({std::move(row), stored});
  }
  if (trial_) {
    last_trial_ = trial_->trial.number;
  }
  trial_.reset();
  request_.reset();
  switch_to_.reset();
}

void OperatorDesk::answer_is_given(int trial) {
  const std::lock_guard lock{mutex_};
  given_ = trial;
}

void OperatorDesk::answer_is_stored(const AnswerInView& answer) {
  const std::lock_guard lock{mutex_};
  given_.reset();
  last_answer_ = answer;
}

std::shared_future<void> OperatorDesk::participant_corrects(const std::string& text) {
  return post({OperatorAction::correct, text, {}, results::GivenBy::participant}).stored;
}

void OperatorDesk::force_is(ForceState force) {
  const std::lock_guard lock{mutex_};
  force_ = force;
}

void OperatorDesk::device_says(const std::string& text) {
  const std::lock_guard lock{device_mutex_};
  device_says_ = text;
}

std::string OperatorDesk::device_said() const {
  const std::lock_guard lock{device_mutex_};
  return device_says_;
}

bool OperatorDesk::is_paused() const {
  const std::lock_guard lock{mutex_};
  return is_paused_;
}

std::optional<TrialRequest> OperatorDesk::request() const {
  const std::lock_guard lock{mutex_};
  return request_;
}

std::optional<std::size_t> OperatorDesk::take_switch() {
  const std::lock_guard lock{mutex_};
  return std::exchange(switch_to_, std::nullopt);
}

std::string OperatorDesk::end_reason() const {
  const std::lock_guard lock{mutex_};
  return end_reason_;
}

// What the operator sees of the desk.
namespace {
bool is_over(const std::shared_future<void>& future) {
  return future.wait_for(std::chrono::seconds{0}) == std::future_status::ready;
}

bool has_succeeded(const std::shared_future<void>& future) {
  try {
    future.get();
    return true;
  } catch (const std::exception&) {
    return false;
  }
}
}  // namespace

// As far as it is stored.
bool OperatorDesk::is_excluded() const {
  bool is = session_.is_excluded;
  for (const Logged& logged : log_) {
    const bool is_about_it = logged.row.action == name(OperatorAction::exclude) ||
                             logged.row.action == name(OperatorAction::include);
    if (is_about_it && is_over(logged.stored) && has_succeeded(logged.stored)) {
      is = logged.row.action == name(OperatorAction::exclude);
    }
  }
  return is;
}

DeskView OperatorDesk::view() const {
  const std::lock_guard lock{mutex_};
  DeskView view{trial_,     current_, last_answer_,  {}, force_,
                is_paused_, held_by_, device_said(), {}};
  for (const Logged& logged : log_) {
    const bool is_stored = is_over(logged.stored) && has_succeeded(logged.stored);
    view.log.push_back({logged.row, is_stored});
    if (is_stored && logged.row.action == name(OperatorAction::correct) && view.last_answer &&
        logged.row.number == view.last_answer->trial.number) {
      view.last_answer->response = logged.row.detail;
    }
  }
  for (const ActionInfo& info : operator_actions()) {
    if (is_possible(info.action)) {
      view.possible.push_back(info.action);
    }
  }
  return view;
}
}  // namespace tapstudy::runner
