#include "runner/session/engine/presentation.hpp"

#include <algorithm>
#include <limits>

#include "runner/session/engine/trial_record.hpp"
#include "runner/session/participants/planned_taps.hpp"
#include "runner/session/participants/trial_control.hpp"
#include "runner/session/stimuli/model_library.hpp"
#include "runner/terminal/logging.hpp"
#include "runner/terminal/process_exit.hpp"
namespace tapstudy::runner {
namespace {
// The operator's requests reach the trial, its selected alternative the operator, and each answer
// that is entered, changed or withdrawn becomes a state of the session.
TrialLinks links_of(const TrialInView& view, const SessionParts& parts) {
  return {[&by = parts.by] {
            return OperatorRequests{by.take_switch(), by.request(), by.is_paused()};
          },
          [&by = parts.by](std::size_t alternative) { by.alternative_is_selected(alternative); },
          [&](const std::string& answer) {
            const protocols::PlannedTrial& trial = view.trial;
            parts.states.enter(
                SessionState::answering, trial.number,
                answer.empty()
                    ? ""
                    : trial.task->response(trial, parts.protocol.block(trial.block), answer));
          }};
}

// Ends with an answer that may be given, the end of the block's time, a request of the operator, a
// stop or a fault.
void ask(const TrialInView& view, TrialControl& control, const SessionParts& parts,
         Presentation& presentation) {
  const protocols::PlannedTrial& trial = view.trial;
  const protocols::Block& block = parts.protocol.block(trial.block);
  // an answer that was accepted in time may be handed over a little later
  constexpr double handover_s = 0.05;
  const double latest_s =
      view.prompt.block->explore.max_seconds.value_or(std::numeric_limits<double>::infinity()) +
      handover_s;
  while (const auto answer = parts.participant.perform(view.prompt, control)) {
    if (control.time_s() > latest_s) {
      break;
    }
    const std::optional<TooEarly> why = too_early(view.prompt, *answer, control.explored());
    const bool is_rendering = control.is_rendering();
    if (!why && is_rendering) {
      presentation.answer = Answer{trial.task->response(trial, block, *answer),
                                   std::min(control.time_s(), latest_s - handover_s)};
      parts.states.enter(SessionState::confirmed, trial.number);
      return;
    }
    if (!is_rendering) {
      presentation.is_answered_in_a_stall = control.is_loop_running();
      break;
    }
    parts.participant.refused(view.prompt, *why);
  }
  if (control.is_loop_running() && !stop_was_asked()) {
    presentation.is_timed_out = control.is_time_over();
    if (const auto& ended = control.ended_by_operator()) {
      presentation.request = ended->end;
      presentation.is_paused = ended->is_paused;
    }
  }
}

TrialStimuli stimuli_of(const protocols::PlannedTrial& trial, bool is_of_real_plate,
                        const SessionParts& parts) {
  if (is_of_real_plate) {
    parts.participant.plate_is_changed();
    return parts.real_plates.mount(trial.alternatives.front().stimulus);
  }
  std::vector<protocols::PresentedStimulus> presented;
  const protocols::Block& block = parts.protocol.block(trial.block);
  for (const protocols::Alternative& alternative : rendered(trial, block)) {
    presented.push_back(protocols::stimulus_at(
        parts.protocol, parts.protocol.stimulus(alternative.stimulus), alternative.values));
  }
  return build_trial_stimuli(parts.protocol, presented, parts.models, parts.actuator);
}

// The events of the trace come first among those at the same time.
void add_in_time(const std::vector<results::EventRow>& more,
                 std::vector<results::EventRow>& events) {
  events.insert(events.end(), more.begin(), more.end());
  std::ranges::stable_sort(events, {}, &results::EventRow::t_s);
}
}  // namespace

Presentation present(const TrialInView& trial, const SessionParts& parts) {
  const bool is_of_real_plate = trial.prompt.block->presented == protocols::Presented::real_plates;
  parts.states.enter(SessionState::ready, trial.trial.number);
  TrialStimuli stimuli = stimuli_of(trial.trial, is_of_real_plate, parts);
  TrialLoop& loop = is_of_real_plate ? parts.real_plates.loop() : parts.trial_loop;
  if (!is_of_real_plate) {
    parts.by.force_is(ForceState::on);  // a device may pull while it gets ready
  }
  parts.participant.get_ready(trial.prompt);
  Presentation presentation;
  TrialEvents events{[&](const results::EventRow& event) {
    if (parts.tell) {
      parts.tell(event, trial.trial.number);
    }
  }};
  const Rendered rendered{stimuli.alternatives,
                          scripted_tap(parts.protocol, trial.prompt.block->explore.scripted_taps),
                          stimuli.voices};
  if (rendered.scripted) {
    events.add({0.0, "scripted_taps", rendered.scripted->speed_m_s});
  }
  presentation.result = loop.run(rendered, [&](Exploration& exploration) {
    parts.states.enter(SessionState::exploring, trial.trial.number);  // masking is heard by now
    parts.by.trial_begins(trial);
    TrialControl control{exploration, rules_of(trial.trial, *trial.prompt.block), events,
                         links_of(trial, parts)};
    try {
      ask(trial, control, parts, presentation);
    } catch (...) {
      presentation.failure = std::current_exception();
    }
  });
  add_in_time(events.rows(), presentation.result.trace.events);
  parts.by.trial_is_over(presentation.request);
  parts.by.force_is(loop.is_force_off() ? ForceState::off : ForceState::unknown);
  if (presentation.result.loop.stop == device::StopOutcome::unconfirmed) {
    warn(device::force_may_be_on);  // before anything else can fail
  }
  return presentation;
}
}  // namespace tapstudy::runner
