#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runner/participants/participant.hpp"
namespace tapstudy::runner {
enum class ScreenKind {
  wait,
  instructions,
  rest,
  trial,
  confidence,
  feedback,
  message,
  form,
  paused,
  ended
};
// Sentences that are the program's own; pages say them in their language.
enum class Message {
  none,
  practice_is_over,
  presented_again,
  skipped,
  time_is_over,
  comes_again,
  operator_is_needed,
  plate_is_mounted
};
// What became of the participant's correction of the last answer.
enum class CorrectionState { none, stored, failed };

struct TrialScreen {
  TrialPrompt prompt;
  std::size_t current{};                     // the alternative that is rendered
  std::size_t setting{};                     // of the last alternative, where it has some
  std::optional<IntervalState> intervals{};  // where alternatives come one after the other
  std::optional<TooEarly> notice;
  CorrectionState correction{CorrectionState::none};
};
struct FeedbackScreen {
  bool is_correct{};
  std::string right;
};
// What the participant sees.
struct Screen {
  ScreenKind kind{ScreenKind::wait};
  std::string text{};
  Message message{Message::none};
  double min_seconds{};                 // of a rest
  std::optional<double> max_seconds{};  // likewise; unset: it does not end by itself
  std::optional<TrialProgress> progress{};
  std::optional<TrialScreen> trial{};
  std::optional<protocols::Confidence> confidence{};
  std::optional<FeedbackScreen> feedback{};
  std::optional<protocols::Form> form{};
  std::optional<int> scene{};
};

// What the participant does with it.
// enter: an answer that is picked or typed and not confirmed yet; empty: there is none any more.
enum class ScreenAction {
  go_on,
  switch_to,
  replay,
  adjust,
  enter,
  answer,
  correct,
  confidence,
  form
};
struct ScreenInput {
  ScreenAction action{};
  std::size_t value{};
  Participant::FormAnswers answers{};  // form
  std::string text{};                  // enter, answer, correct
  bool operator==(const ScreenInput& other) const = default;
};
// Whether that is one of the things that can be done with this screen.
bool accepts(const Screen& screen, const ScreenInput& input);

// Throws InvalidInput if the text is no input; the number of the screen that it belongs to is
// returned in `screen`.
ScreenInput parse_input(const std::string& json, std::int64_t& screen);

struct ScreenContext {
  std::int64_t number{};
  std::string language;
  std::string title;  // of the study
};
std::string to_json(const Screen& screen, const ScreenContext& context);
}  // namespace tapstudy::runner
