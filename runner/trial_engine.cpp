#include "runner/trial_engine.hpp"

#include <fmt/format.h>

#include "runner/exit_code.hpp"
#include "runner/scene.hpp"
#include "runner/stop_signal.hpp"
#include "runner/trial_record.hpp"
namespace tapstudy::runner {
using protocols::PlannedTrial;
using protocols::Task;

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

Presentation TrialEngine::presentation_of(const PlannedTrial& trial, int total) const {
  const protocols::Block& block = protocol_.block(trial.block);
  Presentation presentation{trial.number, total, trial.is_practice, trial.task, block.question,
                            {},           {}};
  if (trial.task == Task::identification) {
    for (const std::string& response : block.responses) {
      presentation.options.push_back(response);
      presentation.option_labels.push_back(protocol_.stimulus(response).label);
    }
    return presentation;
  }
  for (std::size_t i = 0; i < trial.stimuli.size(); ++i) {
    presentation.options.push_back(protocols::blind_label(i));
  }
  presentation.option_labels = presentation.options;
  return presentation;
}

std::optional<Interruption> TrialEngine::run_trial(std::int64_t session_id,
                                                   const PlannedTrial& trial, int total) {
  const Presentation presentation = presentation_of(trial, total);
  Scene scene = build_scene(protocol_, trial.stimuli, models_);
  participant_.get_ready(presentation);
  std::optional<Answer> answer;
  Presented presented = presenter_.present(scene.alternatives, [&](Exploration& exploration) {
    const auto option = participant_.perform(presentation, exploration);
    if (option && exploration.is_running()) {
      answer = Answer{trial.task == Task::identification ? presentation.options.at(*option)
                                                         : trial.stimuli.at(*option),
                      exploration.time_s()};
    }
  });
  const core::TickFault fault = presented.loop.stopped_by;
  ticks_ += presented.loop.ticks;
  recorder_
      .save(
          trial_record(session_id, trial, ++attempts_[trial.number], answer, std::move(presented)))
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
  participant_.saved(presentation);
  return std::nullopt;
}
}  // namespace tapstudy::runner
