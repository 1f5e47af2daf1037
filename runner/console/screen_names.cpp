#include "runner/console/screen_names.hpp"
namespace tapstudy::runner {
const char* name(ScreenKind value) {
  using enum ScreenKind;
  switch (value) {
    case wait:
      return "wait";
    case instructions:
      return "instructions";
    case rest:
      return "rest";
    case trial:
      return "trial";
    case confidence:
      return "confidence";
    case feedback:
      return "feedback";
    case message:
      return "message";
    case form:
      return "form";
    case paused:
      return "paused";
    case ended:
      return "ended";
  }
  return "";
}

const char* name(Message value) {
  using enum Message;
  switch (value) {
    case none:
      return "";
    case practice_is_over:
      return "practice_is_over";
    case presented_again:
      return "presented_again";
    case skipped:
      return "skipped";
    case time_is_over:
      return "time_is_over";
    case comes_again:
      return "comes_again";
    case operator_is_needed:
      return "operator_is_needed";
    case plate_is_mounted:
      return "plate_is_mounted";
  }
  return "";
}

const char* name(TooEarly::Reason value) {
  using enum TooEarly::Reason;
  switch (value) {
    case intervals:
      return "intervals";
    case plate_untouched:
      return "plate_untouched";
    case alternatives_untouched:
      return "alternatives_untouched";
    case plate_unfelt:
      return "plate_unfelt";
    case alternatives_unfelt:
      return "alternatives_unfelt";
    case time:
      return "time";
  }
  return "";
}

const char* name(IntervalState::Phase value) {
  using enum IntervalState::Phase;
  switch (value) {
    case gap:
      return "gap";
    case leaving:
      return "leaving";
    case open:
      return "open";
    case over:
      return "over";
  }
  return "";
}

const char* name(CorrectionState value) {
  using enum CorrectionState;
  switch (value) {
    case none:
      return "";
    case stored:
      return "stored";
    case failed:
      return "failed";
  }
  return "";
}
}  // namespace tapstudy::runner
