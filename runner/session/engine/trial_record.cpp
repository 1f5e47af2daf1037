#include "runner/session/engine/trial_record.hpp"

#include <fmt/format.h>

#include "device/device.hpp"
#include "results/traces/trace_collector.hpp"
#include "runner/session/engine/alternative_rows.hpp"
namespace tapstudy::runner {
std::optional<SessionState> state_of(TrialEnding ending) {
  switch (ending) {
    case TrialEnding::answered:
      return SessionState::saved;
    case TrialEnding::repeated:
      return SessionState::repeated;
    case TrialEnding::timed_out:
      return SessionState::timed_out;
    case TrialEnding::skipped:
      return SessionState::skipped;
    case TrialEnding::paused:
      return SessionState::paused;
    case TrialEnding::faulted:
      return SessionState::faulted;
    case TrialEnding::interrupted:
      break;
  }
  return std::nullopt;
}

results::TrialStatus status_of(TrialEnding ending, bool is_answered) {
  using results::TrialStatus;
  switch (ending) {
    case TrialEnding::answered:
      return TrialStatus::answered;
    case TrialEnding::repeated:
      return TrialStatus::repeated;
    case TrialEnding::timed_out:
      return TrialStatus::timed_out;
    case TrialEnding::skipped:
      return TrialStatus::skipped;
    case TrialEnding::faulted:
      return is_answered ? TrialStatus::answered : TrialStatus::interrupted;
    case TrialEnding::paused:
    case TrialEnding::interrupted:
      break;
  }
  return TrialStatus::interrupted;
}

std::string to_text(const Interruption& interruption) {
  return fmt::format(
      "trial {}: {}; {}, {}", interruption.trial, core::to_text(interruption.fault),
      interruption.is_force_off
          ? "force is off"
          : fmt::format("{} (the device did not confirm zero force)", device::force_may_be_on),
      interruption.is_answered ? "the answer is stored" : "the trial is stored as interrupted");
}

namespace {
results::ResponseRow response_row(const protocols::PlannedTrial& trial,
                                  const protocols::Block& block, const Answer& answer,
                                  const std::vector<results::EventRow>& events) {
  results::ResponseRow response{answer.response,
                                trial.task->is_correct(trial, block, answer.response),
                                answer.response_time_s, std::nullopt, answer.confidence};
  if (const auto contact_s = results::first_contact_s(events)) {
    response.time_from_first_contact_s = answer.response_time_s - *contact_s;
  }
  return response;
}
}  // namespace

results::TrialRecord trial_record(std::int64_t session_id, const protocols::PlannedTrial& trial,
                                  const protocols::Block& block, int attempt,
                                  results::TrialStatus status, const std::optional<Answer>& answer,
                                  TrialResult result) {
  results::TrialRecord record;
  record.trial = {session_id,
                  trial.number,
                  attempt,
                  trial.block,
                  std::string{trial.task->name()},
                  trial.is_practice,
                  trial.repetition,
                  status,
                  result.trace.duration_s,
                  trial.is_catch,
                  block.presented == protocols::Presented::real_plates};
  record.alternatives = alternative_rows(trial, block);
  if (answer) {
    record.response = response_row(trial, block, *answer, result.trace.events);
  }
  record.statistics = {result.trace.ticks,
                       result.loop.late,
                       result.loop.skipped,
                       result.trace.ticks > 0 ? result.loop.saturated : 0,
                       result.dropped_samples,
                       1e-9 * static_cast<double>(result.loop.lateness.quantile(0.999)),
                       1e-9 * static_cast<double>(result.loop.lateness.worst()),
                       to_text(result.loop.stopped_by)};
  record.events = std::move(result.trace.events);
  record.trace = std::move(result.trace.chunks);
  if (!result.trace.actuator.empty()) {
    record.actuator = result.actuator;
    record.actuator_chunks = std::move(result.trace.actuator);
  }
  return record;
}
}  // namespace tapstudy::runner
