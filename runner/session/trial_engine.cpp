#include "runner/session/trial_engine.hpp"

#include <fmt/format.h>

#include "runner/session/trial_record.hpp"
#include "runner/stimuli/trial_stimuli.hpp"
#include "runner/terminal/exit_code.hpp"
#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
using protocols::PlannedTrial;

std::string to_text(const Interruption& interruption) {
  return fmt::format(
      "trial {}: {}; force is off, {}", interruption.trial, core::to_text(interruption.fault),
      interruption.is_answered ? "the answer is stored" : "the trial is stored as interrupted");
}

std::optional<Interruption> TrialEngine::run(std::int64_t session_id,
                                             const protocols::Schedule& schedule,
                                             std::set<int>& done_trials) {
  for (const PlannedTrial& trial : schedule) {
    if (done_trials.contains(trial.number)) {
      continue;
    }
    stop_if_asked();
    const auto interruption = run_trial(session_id, trial, static_cast<int>(schedule.size()));
    if (!interruption || interruption->is_answered) {
      done_trials.insert(trial.number);
    }
    if (interruption) {
      return interruption;
    }
  }
  return std::nullopt;
}

TrialPrompt TrialEngine::prompt_of(const PlannedTrial& trial, int total) const {
  const protocols::Block& block = protocol_.block(trial.block);
  return {trial.number,
          total,
          trial.is_practice,
          trial.task,
          block.question,
          trial.task->options(block, protocol_),
          trial.task->alternative_labels(trial)};
}

std::optional<Interruption> TrialEngine::run_trial(std::int64_t session_id,
                                                   const PlannedTrial& trial, int total) {
  const TrialPrompt prompt = prompt_of(trial, total);
  TrialStimuli stimuli = build_trial_stimuli(protocol_, trial.stimuli, models_);
  participant_.get_ready(prompt);
  std::optional<Answer> answer;
  TrialResult result = trial_loop_.run(stimuli.alternatives, [&](Exploration& exploration) {
    const auto option = participant_.perform(prompt, exploration);
    if (option && exploration.is_running()) {
      answer = Answer{trial.task->response(trial, protocol_.block(trial.block), *option),
                      exploration.time_s()};
    }
  });
  const core::TickFault fault = result.loop.stopped_by;
  ticks_ += result.loop.ticks;
  recorder_
      .save(trial_record(session_id, trial, ++attempts_[trial.number], answer, std::move(result)))
      .get();
  if (fault != core::TickFault::none) {
    return Interruption{trial.number, fault, answer.has_value()};
  }
  if (!answer) {
    throw Stopped{
        fmt::format("stopped in trial {} of {}; every answer given so far is kept (go on "
                    "with --resume)",
                    trial.number, total)};
  }
  participant_.saved(prompt);
  return std::nullopt;
}
}  // namespace tapstudy::runner
