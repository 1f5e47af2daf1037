#include "runner/session/participants/participant.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
namespace tapstudy::runner {
RestTimes rest_times(const protocols::Breaks& breaks) {
  using Clock = std::chrono::steady_clock;
  const auto in = [now = Clock::now()](double seconds) {
    return now +
           std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>{seconds});
  };
  return {in(breaks.min_seconds),
          breaks.max_seconds ? in(*breaks.max_seconds) : Clock::time_point::max()};
}

std::string place_in(const TrialProgress& progress) {
  return progress.is_open_ended ? fmt::format("{}", progress.done + 1)
                                : fmt::format("{} of {}", progress.done + 1, progress.total);
}

std::optional<std::size_t> TrialPrompt::alternative_of(const std::string& answer) const {
  const auto found = std::ranges::find(alternative_labels, answer);
  return found == alternative_labels.end()
             ? answers.judged
             : std::optional{static_cast<std::size_t>(found - alternative_labels.begin())};
}

bool TrialPrompt::answers_name_alternatives() const {
  return !answers.options.empty() && alternative_of(answers.options.front().name).has_value();
}

std::string to_text(const TooEarly& too_early) {
  const std::string times =
      too_early.min_contacts == 1 ? "" : fmt::format(" {} times", too_early.min_contacts);
  switch (too_early.reason) {
    case TooEarly::Reason::intervals:
      return "please feel each of them first: they come one after the other";
    case TooEarly::Reason::plate_untouched:
      return fmt::format("please tap the plate{} first", times);
    case TooEarly::Reason::alternatives_untouched:
      return fmt::format("please tap {}{} first", fmt::join(too_early.labels, ", "), times);
    case TooEarly::Reason::plate_unfelt:
      return fmt::format("please wait until you have felt the plate{}", times);
    case TooEarly::Reason::alternatives_unfelt:
      return fmt::format("please feel {}{} first", fmt::join(too_early.labels, ", "), times);
    case TooEarly::Reason::time:
      break;
  }
  return fmt::format("please take {:.3g} s at least", too_early.min_seconds);
}
}  // namespace tapstudy::runner
