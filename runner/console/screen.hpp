#pragma once
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "runner/session/participants/trial_rules.hpp"
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
  std::optional<double> seconds_left{};  // to answer in; unset: there is no limit
};
struct FeedbackScreen {
  bool is_correct{};
  std::string right;
};
// What the participant sees.
struct Screen {
  ScreenKind kind{ScreenKind::wait};
  std::string text{};
  std::optional<protocols::Picture> picture{};  // beside the text
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
  protocols::FormAnswers answers{};  // form
  std::string text{};                // enter, answer, correct
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

// By which pages know these.
const char* name(ScreenKind kind);
const char* name(Message message);
const char* name(TooEarly::Reason reason);
const char* name(IntervalState::Phase phase);
const char* name(CorrectionState correction);

// Between the session, which shows screens, and the server's threads, which take what is done with
// them. An input belongs to one screen: what comes for an earlier one, or a second time, is
// refused.
class ScreenExchange {
 public:
  ScreenExchange(std::string language, std::string title)
      : language_{std::move(language)}, title_{std::move(title)} {}

  // The session's thread. Returns the screen's number.
  std::int64_t show(const Screen& screen);
  std::optional<ScreenInput> take(std::int64_t number);
  // What was entered last, and not taken yet: empty if that was withdrawn.
  std::optional<std::string> take_entered();
  // Takes no more input for the screen that is shown; what was accepted already is returned.
  std::optional<ScreenInput> close();

  // Any thread.
  struct Shown {
    std::int64_t number{};
    std::string json;
    std::optional<int> scene;
  };
  Shown shown() const;
  std::int64_t number() const;
  // Empty: accepted; otherwise why not. The same input again, of the same screen, is accepted.
  // What is only entered answers nothing: more of it may follow, and an answer.
  std::string post(std::int64_t number, const ScreenInput& input);
  // A page that says so now and then is gone once it is silent, though its connection is open.
  void page_is_alive(std::chrono::steady_clock::time_point now);
  void page_opened(std::chrono::steady_clock::time_point now);
  void page_closed(std::chrono::steady_clock::time_point now);
  // When there was last a sign of somebody who may be looking: now, if a page is open that never
  // says so.
  std::chrono::steady_clock::time_point last_seen(std::chrono::steady_clock::time_point now) const;
  int open_pages() const;

 private:
  std::string language_;
  std::string title_;
  mutable std::mutex mutex_;
  Screen screen_;
  std::int64_t number_{0};
  std::optional<ScreenInput> input_;
  std::optional<std::string> entered_;
  bool is_taken_{false};
  bool is_closed_{false};
  int open_pages_{0};
  std::optional<std::chrono::steady_clock::time_point> alive_at_;
  std::chrono::steady_clock::time_point closed_at_;
};
}  // namespace tapstudy::runner
