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
                                  int attempt, const std::optional<Answer>& answer,
                                  Presented presented) {
  results::TrialRecord record;
  record.trial = {session_id,
                  trial.number,
                  attempt,
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

std::string to_text(protocols::Task task) {
  return task == protocols::Task::identification ? "identification" : "choice";
}
}  // namespace tapstudy::runner
