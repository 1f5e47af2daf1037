#include "runner/session/participants/trial_rules.hpp"

#include <algorithm>
namespace tapstudy::runner {
using Phase = IntervalState::Phase;

double TrialRules::seconds_left_of(double seconds, double time_s) const {
  const double left_s = limits.max_seconds ? *limits.max_seconds - time_s : seconds;
  return std::clamp(seconds, 0.0, std::max(0.0, left_s));
}

TrialRules rules_of(const protocols::PlannedTrial& trial, const protocols::Block& block) {
  return {block.explore, std::max<std::size_t>(1, trial.alternatives.size()),
          trial.task->settings(trial, block)};
}

IntervalSequence::IntervalSequence(const TrialRules& rules, double time_s)
    : intervals_{rules.limits.intervals.value()},
      min_contacts_{rules.limits.min_contacts},
      alternatives_{rules.alternatives} {
  state_.replays_left = intervals_.max_replays;
  begin_gap(0, time_s);
}

IntervalSequence::Step IntervalSequence::advance(const Observation& seen) {
  switch (state_.phase) {
    case Phase::gap:
    case Phase::leaving:
      return follow_gap(seen);
    case Phase::open:
      return follow_interval(seen);
    case Phase::over:
      break;
  }
  return Step::none;
}

std::optional<int> IntervalSequence::replay(double time_s) {
  if (state_.phase != Phase::over || state_.replays_left == 0) {
    return std::nullopt;
  }
  --state_.replays_left;
  begin_gap(0, time_s);
  return intervals_.max_replays - state_.replays_left;
}

void IntervalSequence::begin_gap(std::size_t next, double time_s) {
  alternative_ = next;
  is_in_effect_ = false;
  until_s_ = time_s + intervals_.gap_seconds;
  state_.phase = Phase::gap;
}

bool IntervalSequence::is_in_effect(double seconds, const Observation& seen) {
  if (!is_in_effect_ && seen.is_as_requested) {
    is_in_effect_ = true;
    until_s_ = seen.time_s + seconds;
  }
  return is_in_effect_;
}

IntervalSequence::Step IntervalSequence::follow_gap(const Observation& seen) {
  if (!is_in_effect(intervals_.gap_seconds, seen)) {
    state_.phase = seen.time_s >= until_s_ ? Phase::leaving : state_.phase;
    return Step::none;
  }
  state_.phase = Phase::gap;
  if (seen.time_s < until_s_) {
    return Step::none;
  }
  is_in_effect_ = false;
  contacts_before_ = seen.contacts;
  state_.phase = Phase::open;
  return Step::opened;
}

IntervalSequence::Step IntervalSequence::follow_interval(const Observation& seen) {
  if (!is_in_effect(intervals_.seconds, seen) || seen.time_s < until_s_ ||
      seen.contacts - contacts_before_ < min_contacts_) {
    return Step::none;
  }
  if (alternative_ + 1 < alternatives_) {
    begin_gap(alternative_ + 1, seen.time_s);
  } else {
    state_.phase = Phase::over;
  }
  return Step::closed;
}

namespace {
// Labels of the alternatives that still have to be touched.
std::vector<std::string> untouched(const TrialPrompt& prompt, const std::string& answer,
                                   const Explored& explored) {
  const std::optional<std::size_t> answered = prompt.alternative_of(answer);
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < prompt.alternative_labels.size(); ++i) {
    const bool is_asked_for = prompt.block->explore.must_visit_all || i == answered;
    if (is_asked_for && explored.contacts.at(i) < prompt.block->explore.min_contacts) {
      labels.push_back(prompt.alternative_labels[i]);
    }
  }
  return labels;
}
}  // namespace

std::optional<TooEarly> too_early(const TrialPrompt& prompt, const std::string& answer,
                                  const Explored& explored) {
  using Reason = TooEarly::Reason;
  const protocols::ExploreLimits& limits = prompt.block->explore;
  const bool is_scripted = limits.scripted_taps.has_value();
  if (!explored.are_intervals_over) {
    return TooEarly{Reason::intervals};
  }
  if (prompt.alternative_labels.empty()) {
    if (explored.contacts.at(0) < limits.min_contacts) {
      return TooEarly{is_scripted ? Reason::plate_unfelt : Reason::plate_untouched,
                      limits.min_contacts};
    }
  } else if (const auto labels = untouched(prompt, answer, explored); !labels.empty()) {
    return TooEarly{is_scripted ? Reason::alternatives_unfelt : Reason::alternatives_untouched,
                    limits.min_contacts, labels};
  }
  if (explored.time_s < limits.min_seconds) {
    return TooEarly{Reason::time, 0, {}, limits.min_seconds};
  }
  return std::nullopt;
}
}  // namespace tapstudy::runner
