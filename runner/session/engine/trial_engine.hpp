#pragma once
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "protocols/schedule/schedule.hpp"
#include "results/store/recorder.hpp"
#include "runner/session/engine/adaptive_blocks.hpp"
#include "runner/session/engine/between_trials.hpp"
#include "runner/session/engine/practice.hpp"
#include "runner/session/engine/presentation.hpp"
#include "runner/session/engine/remaining_trials.hpp"
#include "runner/session/engine/session_states.hpp"
#include "runner/session/engine/trial_record.hpp"
#include "runner/session/participants/participant.hpp"
#include "runner/session/stimuli/model_library.hpp"
#include "runner/session/trial_loop/trial_loop.hpp"
namespace tapstudy::runner {
// Takes one participant through a schedule, trial by trial: builds its stimuli, renders them while
// the participant explores, and stores the complete trial.
class TrialEngine {
 public:
  TrialEngine(const SessionParts& parts, results::Recorder& recorder,
              const EarlierAnswers& earlier = {})
      : parts_{parts},
        between_trials_{
            {parts.protocol, parts.participant, parts.states,
             [this](std::vector<results::FormAnswerRow> rows) { save(std::move(rows)); },
             [this] { wait_while_paused(); }},
            earlier.forms,
            earlier.comes_again},
        practice_{parts.protocol, parts.states, earlier.practice},
        as_given_{earlier.as_given},
        recorder_{recorder},
        attempts_{earlier.attempts},
        requeued_{earlier.requeued} {}

  // Runs the trials not in `done`, adding each, until all are done or a fault ends one; called
  // again, it repeats that one. A trial that took too long comes again at the end of its block, if
  // the block says so, as does one that the operator skipped if a procedure chose its level. Throws
  // Stopped if the participant or the operator stops, StoreError if a trial cannot be stored; the
  // trial in progress is stored as interrupted, if possible. Trials that are not presented to who
  // answered so before them count as done, and all do after an answer that ends the session.
  std::optional<Interruption> run(const protocols::Schedule& schedule, std::set<int>& done_trials);
  std::int64_t ticks() const noexcept { return ticks_; }  // rendered so far
  int trials() const noexcept { return trials_; }         // stored so far, however they ended

 private:
  struct Outcome {
    std::optional<Interruption> interruption{};
    bool is_repeated{};  // its answer does not count
    bool is_requeued{};
  };
  std::optional<Interruption> run_all(const protocols::Schedule& schedule,
                                      std::set<int>& done_trials);
  void note_events();
  void note_stop(const std::string& why);
  void ask_confidence(const protocols::Block& block, int trial, Answer& answer);
  void give_feedback(const protocols::PlannedTrial& trial, const TrialPrompt& prompt,
                     const std::string& response);
  void wait_while_paused();
  TrialEnding ending_of(const Presentation& presentation, const protocols::PlannedTrial& trial);
  void store(const protocols::PlannedTrial& trial, Presentation presentation, TrialEnding ending);
  void note_answer(const protocols::PlannedTrial& trial, const TrialPrompt& prompt,
                   const std::string& response);
  struct Course {
    const protocols::Schedule& schedule;
    const SessionProgress& progress;
  };
  Outcome run_trial(const protocols::PlannedTrial& planned, const Course& course);
  Outcome run_until_it_counts(const protocols::PlannedTrial& trial, const Course& course);
  void save(const std::shared_ptr<const results::TrialRecord>& record);
  void save(std::vector<results::FormAnswerRow> answers);
  // Until it succeeds, or the operator gives up: then throws StoreError.
  void retry(const std::function<void()>& write);
  TrialPrompt prompt_of(const protocols::PlannedTrial& trial, const Course& course) const;
  std::optional<TrialPrompt::Previous> correctable() const;

  SessionParts parts_;
  BetweenTrials between_trials_;
  Practice practice_;
  std::vector<results::JournalledAnswer> as_given_;  // in earlier sessions
  std::optional<AdaptiveBlocks> adaptive_;
  results::Recorder& recorder_;
  std::optional<AnswerInView> last_answer_;
  std::map<int, int> attempts_;  // by the trial's number
  std::vector<int> requeued_;    // trials, the last one last
  std::map<int, int> repeats_after_late_impacts_;
  std::int64_t ticks_{0};
  int trials_{0};
  double first_trial_at_s_{0.0};  // without pauses
  bool has_warned_{false};
};
}  // namespace tapstudy::runner
