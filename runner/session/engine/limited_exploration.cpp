#include "runner/session/engine/limited_exploration.hpp"

#include <vector>
namespace tapstudy::runner {
namespace {
// Labels of the alternatives that still have to be touched.
std::vector<std::string> untouched(const TrialPrompt& prompt, const std::string& answer,
                                   const Exploration& exploration) {
  const std::optional<std::size_t> answered = prompt.alternative_of(answer);
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < prompt.alternative_labels.size(); ++i) {
    const bool is_asked_for = prompt.block->explore.must_visit_all || i == answered;
    if (is_asked_for && exploration.contacts(i) < prompt.block->explore.min_contacts) {
      labels.push_back(prompt.alternative_labels[i]);
    }
  }
  return labels;
}
}  // namespace

std::optional<TooEarly> too_early(const TrialPrompt& prompt, const std::string& answer,
                                  const Exploration& exploration) {
  using Reason = TooEarly::Reason;
  const protocols::ExploreLimits& limits = prompt.block->explore;
  const bool is_scripted = limits.scripted_taps.has_value();
  const IntervalState* const intervals = exploration.intervals();
  if (intervals != nullptr && intervals->phase != IntervalState::Phase::over) {
    return TooEarly{Reason::intervals};
  }
  if (prompt.alternative_labels.empty()) {
    if (exploration.contacts(0) < limits.min_contacts) {
      return TooEarly{is_scripted ? Reason::plate_unfelt : Reason::plate_untouched,
                      limits.min_contacts};
    }
  } else if (const auto labels = untouched(prompt, answer, exploration); !labels.empty()) {
    return TooEarly{is_scripted ? Reason::alternatives_unfelt : Reason::alternatives_untouched,
                    limits.min_contacts, labels};
  }
  if (exploration.time_s() < limits.min_seconds) {
    return TooEarly{Reason::time, 0, {}, limits.min_seconds};
  }
  return std::nullopt;
}
}  // namespace tapstudy::runner
