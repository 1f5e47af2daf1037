#include "runner/trial_record.hpp"

#include <algorithm>
namespace tapstudy::runner {
namespace {
std::optional<double> first_contact_s(const std::vector<results::EventRow>& events) {
  const auto contact = std::ranges::find(events, "contact", &results::EventRow::kind);
  return contact == events.end() ? std::nullopt : std::optional{contact->t_s};
}

results::ResponseRow response_row(const protocols::PlannedTrial& trial, const Answer& answer,
                                  const std::vector<results::EventRow>& events) {
  results::ResponseRow response{answer.stimulus, std::nullopt, answer.response_time_s,
                                std::nullopt};
  if (trial.task == protocols::Task::identification) {
    response.is_correct = answer.stimulus == trial.stimuli.front();
  }
  if (const auto contact_s = first_contact_s(events)) {
    response.time_from_first_contact_s = answer.response_time_s - *contact_s;
  }
  return response;
}
}  // namespace

results::TrialRecord trial_record(std::int64_t session_id, const protocols::PlannedTrial& trial,
                                  const std::optional<Answer>& answer, Presented presented) {
  results::TrialRecord record;
  record.trial = {session_id,
                  trial.number,
                  1,
                  trial.block,
                  to_text(trial.task),
                  trial.is_practice,
                  trial.repetition,
                  answer ? "answered" : "interrupted",
                  presented.trace.duration_s};
  for (std::size_t i = 0; i < trial.stimuli.size(); ++i) {
    const bool is_blind = trial.task == protocols::Task::choice;
    record.alternatives.push_back({static_cast<int>(i),
                                   is_blind ? protocols::blind_label(i) : std::string{},
                                   trial.stimuli[i]});
  }
  if (answer) {
    record.response = response_row(trial, *answer, presented.trace.events);
  }
  record.statistics = {presented.trace.ticks,
                       presented.loop.late,
                       presented.loop.skipped,
                       presented.loop.saturated,
                       presented.dropped_samples,
                       1e-9 * static_cast<double>(presented.loop.lateness.quantile(0.999)),
                       1e-9 * static_cast<double>(presented.loop.lateness.worst()),
                       to_text(presented.loop.stopped_by)};
  record.events = std::move(presented.trace.events);
  record.trace = std::move(presented.trace.chunks);
  return record;
}

std::string to_text(core::TickFault fault) {
  switch (fault) {
    case core::TickFault::none:
      return "";
    case core::TickFault::device_gone:
      return "the device is gone";
    case core::TickFault::no_reply:
      return "the device did not reply in time";
    case core::TickFault::bad_reply:
      return "the device's reply was broken";
    case core::TickFault::wrong_echo:
      return "the device got what was never sent";
    case core::TickFault::counter_jumped:
      return "an encoder jumped";
    case core::TickFault::strings_disagree:
      return "the strings' lengths fit no pose (slack, slipped or miscounted)";
    case core::TickFault::not_homed:
      return "the device must be homed first";
    case core::TickFault::outside_workspace:
      return "the hand left the workspace";
    case core::TickFault::too_fast:
      return "the hand was too fast";
    case core::TickFault::non_finite_force:
      return "a force or position was not a number";
    case core::TickFault::too_late:
      return "the loop was late too many times in a row";
    case core::TickFault::heartbeat_lost:
      return "the program around the loop stood still";
  }
  return "";
}

std::string to_text(protocols::Task task) {
  return task == protocols::Task::identification ? "identification" : "choice";
}
}  // namespace tapstudy::runner
