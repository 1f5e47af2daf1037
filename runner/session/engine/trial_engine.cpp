#include "runner/session/engine/trial_engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>

#include "results/store_error.hpp"
#include "runner/session/engine/remaining_trials.hpp"
#include "runner/session/engine/trial_record.hpp"
#include "runner/terminal/logging.hpp"
#include "runner/terminal/process_exit.hpp"
namespace tapstudy::runner {
using protocols::PlannedTrial;

namespace {
bool has_late_impact(const TrialResult& result) {
  return std::ranges::any_of(result.trace.events, [](const results::EventRow& event) {
    return event.kind == "late_impact";
  });
}

// Whether a fault is found some time after it began, up to seconds: an answer given just before may
// be to what nobody felt.
bool is_found_late(core::TickFault fault) {
  using enum core::TickFault;
  constexpr std::array all{position_frozen, force_not_followed, velocity_wrong, periods_missed,
                           too_late,        amplifier_off,      actuator_gaps,  actuator_lost};
  return std::ranges::find(all, fault) != all.end();
}
}  // namespace

std::optional<Interruption> TrialEngine::run(const protocols::Schedule& schedule,
                                             std::set<int>& done_trials) {
  try {
    between_trials_.begin(done_trials.size() < schedule.size());
    const protocols::Schedule presented = between_trials_.presented(schedule);
    const auto interruption = run_all(presented, done_trials);
    if (!interruption) {
      between_trials_.after_last_trial(presented);
      parts_.states.enter(SessionState::ended);
    }
    note_events();
    return interruption;
  } catch (const TookNoPart& answer) {
    parts_.states.enter(SessionState::ended, {}, answer.what());
    note_events();
    return std::nullopt;
  } catch (const PracticeMissed& missed) {
    note_stop(missed.what());
    throw;
  } catch (const Stopped&) {
    note_stop(parts_.by.end_reason());
    throw;
  } catch (const core::Error& error) {
    note_stop(error.what());
    throw;
  }
}

void TrialEngine::note_stop(const std::string& why) {
  parts_.states.enter(SessionState::stopped, {}, why);
  note_events();
}

// The record of states is worth less than what comes next: going on after a fault, the end.
void TrialEngine::note_events() {
  try {
    recorder_.note(parts_.states.take_events()).get();
  } catch (const results::StoreError& error) {
    warn(fmt::format("the session's latest changes of state are not stored: {}", error.what()));
  }
}

std::optional<Interruption> TrialEngine::run_all(const protocols::Schedule& schedule,
                                                 std::set<int>& done_trials) {
  if (!adaptive_) {
    adaptive_.emplace(parts_.protocol, parts_.seed, schedule, as_given_);
  }
  std::deque<PlannedTrial> waiting = waiting_trials(schedule, done_trials, requeued_);
  SessionProgress progress{schedule, done_trials, parts_.protocol};
  const auto note_done = [&](const PlannedTrial& trial) {
    done_trials.insert(trial.number);
    progress.note_done(trial);
  };
  while (!waiting.empty()) {
    stop_if_asked();
    const PlannedTrial trial = waiting.front();
    waiting.pop_front();
    if (!practice_.is_needed(trial, schedule) || adaptive_->is_over(trial)) {
      note_done(trial);
      continue;
    }
    between_trials_.before(trial, schedule);
    const Outcome outcome = run_until_it_counts(trial, {schedule, progress});
    if (outcome.is_requeued) {
      std::erase(requeued_, trial.number);
      requeued_.push_back(trial.number);
      put_at_end_of_block(trial, waiting);
      continue;
    }
    if (!outcome.interruption || outcome.interruption->is_answered) {
      note_done(trial);
    }
    if (outcome.interruption) {
      return outcome.interruption;
    }
  }
  return std::nullopt;
}

TrialPrompt TrialEngine::prompt_of(const PlannedTrial& trial, const Course& course) const {
  const protocols::Block& block = parts_.protocol.block(trial.block);
  TrialProgress progress = course.progress.before(trial);
  progress.elapsed_s = parts_.states.now_s();
  progress.left_s = course.progress.left_s(parts_.states.unpaused_s() - first_trial_at_s_, trials_);
  return {trial.number,
          course.schedule.back().number,
          progress,
          &block,
          protocols::answers_of(block, parts_.protocol),
          trial.task->alternative_labels(trial),
          correctable()};
}

std::optional<TrialPrompt::Previous> TrialEngine::correctable() const {
  if (!last_answer_ || !parts_.protocol.block(last_answer_->trial.block).allows_correction) {
    return std::nullopt;
  }
  return TrialPrompt::Previous{last_answer_->answers, [this](const std::string& text) {
                                 return parts_.by.participant_corrects(text);
                               }};
}

TrialEngine::Outcome TrialEngine::run_until_it_counts(const PlannedTrial& trial,
                                                      const Course& course) {
  Outcome outcome;
  do {
    parts_.participant.arrive();
    wait_while_paused();
    outcome = run_trial(trial, course);
  } while (outcome.is_repeated);
  return outcome;
}

void TrialEngine::wait_while_paused() {
  if (!parts_.by.is_paused()) {
    return;
  }
  if (parts_.states.state() != SessionState::paused) {
    parts_.states.enter(SessionState::paused);
  }
  note_events();
  parts_.participant.wait_while([this] { return parts_.by.is_paused() && !stop_was_asked(); });
  stop_if_asked();
}

// What is to be stored is kept while the operator frees space or ends what locks the database.
void TrialEngine::retry(const std::function<void()>& write) {
  while (true) {
    try {
      write();
      return;
    } catch (const results::StoreRewritten&) {
      throw;
    } catch (const results::StoreError& error) {
      if (!parts_.participant.saves_again(error.what())) {
        throw;
      }
    }
  }
}

void TrialEngine::save(const std::shared_ptr<const results::TrialRecord>& record) {
  retry([&] {
    if (recorder_.save(record).get() == results::SaveOutcome::partly_in_log && !has_warned_) {
      has_warned_ = true;
      warn(
          "another program holds study.db open: a copy of that file alone would lack the latest "
          "trials (copy study.db-wal with it, or close the other program)");
    }
  });
}

void TrialEngine::save(std::vector<results::FormAnswerRow> answers) {
  const double now_s = parts_.states.now_s();
  for (results::FormAnswerRow& answer : answers) {
    answer.session_id = parts_.states.session_id();
    answer.t_s = now_s;
  }
  note_events();
  retry([&] { recorder_.save_form(answers).get(); });
}

// The answer stays, whatever becomes of this question.
void TrialEngine::ask_confidence(const protocols::Block& block, int trial, Answer& answer) {
  if (block.confidence) {
    parts_.states.enter(SessionState::confidence, trial);
    parts_.by.answer_is_given(trial);
    answer.confidence = parts_.participant.confidence(*block.confidence);
  }
}

void TrialEngine::give_feedback(const PlannedTrial& trial, const TrialPrompt& prompt,
                                const std::string& response) {
  const protocols::Block& block = parts_.protocol.block(trial.block);
  const auto is_right = [&](const std::string& other) {
    return trial.task->is_correct(trial, block, other).value_or(false);
  };
  for (const protocols::Option& option : prompt.answers.options) {
    if (is_right(trial.task->response(trial, block, option.name))) {
      parts_.states.enter(SessionState::feedback, trial.number);
      parts_.participant.feedback(is_right(response), option.label);
      return;
    }
  }
}

TrialEnding TrialEngine::ending_of(const Presentation& presentation, const PlannedTrial& trial) {
  if (presentation.result.loop.stopped_by != core::TickFault::none) {
    return TrialEnding::faulted;
  }
  if (presentation.request) {
    return *presentation.request == TrialRequest::skip ? TrialEnding::skipped
                                                       : TrialEnding::repeated;
  }
  if (presentation.is_paused) {
    return TrialEnding::paused;
  }
  const bool is_late = presentation.answer && has_late_impact(presentation.result);
  if (presentation.is_answered_in_a_stall ||
      (is_late && repeats_after_late_impacts_[trial.number]++ <
                      parts_.protocol.block(trial.block).max_late_impact_repeats)) {
    return TrialEnding::repeated;
  }
  if (presentation.answer) {
    return TrialEnding::answered;
  }
  return presentation.is_timed_out ? TrialEnding::timed_out : TrialEnding::interrupted;
}

void TrialEngine::store(const PlannedTrial& trial, Presentation presentation, TrialEnding ending) {
  const core::TickFault fault = presentation.result.loop.stopped_by;
  if (const auto state = state_of(ending)) {
    parts_.states.enter(*state, trial.number, core::to_text(fault));
  }
  auto record = std::make_shared<results::TrialRecord>(
      trial_record(parts_.states.session_id(), trial, parts_.protocol.block(trial.block),
                   ++attempts_[trial.number], status_of(ending, presentation.answer.has_value()),
                   presentation.answer, std::move(presentation.result)));
  record->session_events = parts_.states.take_events();
  save(record);
  ++trials_;
  if (presentation.failure) {
    std::rethrow_exception(presentation.failure);
  }
}

// It is stored.
void TrialEngine::note_answer(const PlannedTrial& trial, const TrialPrompt& prompt,
                              const std::string& response) {
  last_answer_ = AnswerInView{trial, prompt.answers, response};
  parts_.by.answer_is_stored(*last_answer_);
  adaptive_->observe(trial, response);
  practice_.add(trial, response);
}

TrialEngine::Outcome TrialEngine::run_trial(const PlannedTrial& planned, const Course& course) {
  const PlannedTrial trial = adaptive_->with_values(planned);
  first_trial_at_s_ = trials_ == 0 ? parts_.states.unpaused_s() : first_trial_at_s_;
  const TrialPrompt prompt = prompt_of(trial, course);
  const protocols::Block& block = parts_.protocol.block(trial.block);
  Presentation presentation = present({trial, prompt, attempts_[trial.number] + 1}, parts_);
  ticks_ += presentation.result.loop.ticks;
  if (is_found_late(presentation.result.loop.stopped_by)) {
    presentation.answer.reset();
  }
  const TrialEnding ending = ending_of(presentation, trial);
  if (ending == TrialEnding::answered) {
    ask_confidence(block, trial.number, *presentation.answer);
  }
  const std::optional<Answer> answer = presentation.answer;
  const core::TickFault fault = presentation.result.loop.stopped_by;
  store(trial, std::move(presentation), ending);
  switch (ending) {
    case TrialEnding::faulted: {
      if (answer) {
        note_answer(trial, prompt, answer->response);
      }
      parts_.participant.interrupted();
      const bool is_force_off = parts_.trial_loop.is_force_off();  // it may be by now
      parts_.by.force_is(is_force_off ? ForceState::off : ForceState::unknown);
      return {.interruption = Interruption{trial.number, fault, answer.has_value(), is_force_off}};
    }
    case TrialEnding::timed_out: {
      const bool is_requeued = block.explore.at_limit == protocols::AtLimit::requeue;
      parts_.participant.timed_out(prompt, is_requeued);
      return {.is_requeued = is_requeued};
    }
    case TrialEnding::repeated:
      parts_.participant.repeats(prompt);
      return {.is_repeated = true};
    case TrialEnding::paused:
      return {.is_repeated = true};
    case TrialEnding::skipped:
      parts_.participant.skipped(prompt);
      return {.is_requeued = do_skipped_trials_come_again(block)};
    case TrialEnding::interrupted:
      throw Stopped{fmt::format(
          "stopped in trial {} of {}; every answer given so far is kept (go on with --resume)",
          trial.number, prompt.total)};
    case TrialEnding::answered:
      break;
  }
  note_answer(trial, prompt, answer->response);
  parts_.participant.saved(prompt);
  if (block.gives_feedback) {
    give_feedback(trial, prompt, answer->response);
  }
  return {};
}
}  // namespace tapstudy::runner
