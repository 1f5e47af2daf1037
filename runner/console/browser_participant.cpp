#include "runner/console/browser_participant.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "results/store_error.hpp"
#include "runner/session/participants/trial_control.hpp"
#include "runner/terminal/process_exit.hpp"
namespace tapstudy::runner {
namespace {
constexpr std::chrono::milliseconds poll_interval{10};

std::optional<IntervalState> intervals(const TrialControl& control) {
  const IntervalState* const state = control.intervals();
  return state == nullptr ? std::nullopt : std::optional{*state};
}
}  // namespace

std::int64_t BrowserParticipant::show(Screen screen) {
  screen.progress = progress_;
  return screens_.show(screen);
}

ScreenInput BrowserParticipant::answer_to(Screen screen) {
  return answer_before(std::chrono::steady_clock::time_point::max(), std::move(screen)).value();
}

std::optional<ScreenInput> BrowserParticipant::answer_before(
    std::chrono::steady_clock::time_point latest, Screen screen) {
  const std::int64_t number = show(std::move(screen));
  while (std::chrono::steady_clock::now() < latest) {
    if (const auto input = screens_.take(number)) {
      return *input;
    }
    stop_if_asked();
    std::this_thread::sleep_for(poll_interval);
  }
  return std::nullopt;
}

void BrowserParticipant::tell(Message message) {
  answer_to({.kind = ScreenKind::message, .message = message});
}

void BrowserParticipant::read(const std::string& instructions,
                              const std::optional<protocols::Picture>& picture) {
  answer_to({.kind = ScreenKind::instructions, .text = instructions, .picture = picture});
}

void BrowserParticipant::practice_is_over() {
  progress_.reset();
  tell(Message::practice_is_over);
}

// The page counts the time down, but does not decide.
void BrowserParticipant::rest(const protocols::Breaks& breaks) {
  const RestTimes times = rest_times(breaks);
  const auto left_s = [](std::chrono::steady_clock::time_point until) {
    return std::chrono::duration<double>(until - std::chrono::steady_clock::now()).count();
  };
  do {
    answer_before(
        times.latest,
        {.kind = ScreenKind::rest,
         .min_seconds = std::max(0.0, left_s(times.earliest)),
         .max_seconds = breaks.max_seconds ? std::optional{left_s(times.latest)} : std::nullopt});
  } while (left_s(times.earliest) > 0.0);
}

protocols::FormAnswers BrowserParticipant::fill_in(const protocols::Form& form) {
  return answer_to({.kind = ScreenKind::form, .form = form}).answers;
}

void BrowserParticipant::wait_while(const std::function<bool()>& is_paused) {
  show({.kind = ScreenKind::paused});
  while (is_paused()) {
    std::this_thread::sleep_for(poll_interval);
  }
}

// Nothing is rendered before somebody can see what is asked.
void BrowserParticipant::arrive() {
  if (screens_.open_pages() == 0) {
    show({.kind = ScreenKind::wait});
  }
  while (screens_.open_pages() == 0) {
    stop_if_asked();
    std::this_thread::sleep_for(poll_interval);
  }
}

void BrowserParticipant::get_ready(const TrialPrompt& prompt) {
  progress_ = prompt.progress;
  notice_.reset();
  correction_ = {};
  correction_state_ = CorrectionState::none;
  screens_.take_entered();  // of an earlier trial
  context_.move_hand();
}

std::int64_t BrowserParticipant::show_trial(const TrialPrompt& prompt,
                                            const TrialControl& control) {
  const std::size_t current = control.current();
  const auto limit_s = prompt.block->explore.max_seconds;
  return show(
      {.kind = ScreenKind::trial,
       .trial = TrialScreen{prompt, current, control.setting(), intervals(control), notice_,
                            std::exchange(correction_state_, CorrectionState::none),
                            limit_s ? std::optional{*limit_s - control.time_s()} : std::nullopt},
       .scene = context_.scene(current)});
}

std::optional<std::string> BrowserParticipant::perform(const TrialPrompt& prompt,
                                                       TrialControl& control) {
  constexpr double poll_s = 0.01;
  std::size_t current = control.current();
  auto in_turn = intervals(control);
  std::int64_t number = show_trial(prompt, control);
  asked_at_ = std::chrono::steady_clock::now();
  while (control.poll() && !stop_was_asked()) {
    pause_if_page_silent();
    tell_entered(prompt, control);
    auto input = screens_.take(number);
    // by the operator, or as intervals begin and end
    const bool is_switched = control.current() != current || intervals(control) != in_turn;
    if (!input && is_switched) {
      input = screens_.close();
    }
    if (input && input->action == ScreenAction::answer) {
      notice_.reset();
      const auto answer = answer_in(input->text, prompt.answers);
      control.enter_answer(answer.value_or(""));  // had it not arrived yet
      return answer;
    }
    if (input) {
      act_on(*input, prompt, control);
    }
    if (input || is_switched || follow_correction()) {
      notice_.reset();
      current = control.current();
      in_turn = intervals(control);
      number = show_trial(prompt, control);
    }
    control.pass_time(poll_s);
  }
  return last_word(prompt, control);
}

void BrowserParticipant::tell_entered(const TrialPrompt& prompt, TrialControl& control) {
  if (const auto entered = screens_.take_entered()) {
    control.enter_answer(answer_in(*entered, prompt.answers).value_or(""));
  }
}

void BrowserParticipant::act_on(const ScreenInput& input, const TrialPrompt& prompt,
                                TrialControl& control) {
  if (input.action == ScreenAction::correct) {
    correction_ = prompt.previous->correct(input.text);
  } else if (input.action == ScreenAction::adjust) {
    control.adjust(input.value);
  } else if (input.action == ScreenAction::replay) {
    control.replay();
  } else {
    control.switch_to(input.value);
  }
}

// What the page was told to be accepted in the moment before the trial ended.
std::optional<std::string> BrowserParticipant::last_word(const TrialPrompt& prompt,
                                                         TrialControl& control) {
  const auto accepted = screens_.close();
  if (accepted && accepted->action == ScreenAction::answer) {
    return answer_in(accepted->text, prompt.answers);
  }
  if (accepted) {
    act_on(*accepted, prompt, control);
  }
  return std::nullopt;
}

bool BrowserParticipant::follow_correction() {
  if (!correction_.valid() ||
      correction_.wait_for(std::chrono::seconds{0}) != std::future_status::ready) {
    return false;
  }
  correction_state_ = CorrectionState::stored;
  try {
    std::exchange(correction_, {}).get();
  } catch (const results::StoreError&) {
    correction_state_ = CorrectionState::failed;
  }
  return true;
}

// Force is not left on for somebody who may have gone.
void BrowserParticipant::pause_if_page_silent() {
  constexpr std::chrono::seconds patience{3};
  const auto now = std::chrono::steady_clock::now();
  if (now - std::max(screens_.last_seen(now), asked_at_) > patience) {
    asked_at_ = now;
    context_.pause("the participant's page is closed or does not answer");
  }
}

std::optional<int> BrowserParticipant::confidence(const protocols::Confidence& scale) {
  const std::int64_t number = show({.kind = ScreenKind::confidence, .confidence = scale});
  while (!stop_was_asked()) {
    if (const auto input = screens_.take(number)) {
      return static_cast<int>(input->value);
    }
    std::this_thread::sleep_for(poll_interval);
  }
  return std::nullopt;
}

void BrowserParticipant::feedback(bool is_correct, const std::string& right_label) {
  answer_to({.kind = ScreenKind::feedback, .feedback = FeedbackScreen{is_correct, right_label}});
}

void BrowserParticipant::refused(const TrialPrompt& /*prompt*/, const TooEarly& why) {
  notice_ = why;
}

void BrowserParticipant::timed_out(const TrialPrompt& /*prompt*/, bool is_presented_again) {
  tell(is_presented_again ? Message::comes_again : Message::time_is_over);
}

bool BrowserParticipant::saves_again(const std::string& cause) {
  show({.kind = ScreenKind::message, .message = Message::operator_is_needed});
  return context_.ask_operator(cause);
}

void BrowserParticipant::repeats(const TrialPrompt& /*prompt*/) {
  tell(Message::presented_again);
}

void BrowserParticipant::plate_is_changed() {
  show({.kind = ScreenKind::message, .message = Message::plate_is_mounted});
}

void BrowserParticipant::interrupted() {
  show({.kind = ScreenKind::message, .message = Message::operator_is_needed});
}

void BrowserParticipant::skipped(const TrialPrompt& /*prompt*/) {
  tell(Message::skipped);
}

void BrowserParticipant::saved(const TrialPrompt& prompt) {
  progress_ = prompt.progress;
  ++progress_->done;
}
}  // namespace tapstudy::runner
