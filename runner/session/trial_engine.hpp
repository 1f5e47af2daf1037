#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/tick_fault.hpp"
#include "protocols/schedule.hpp"
#include "results/recorder.hpp"
#include "runner/participants/participant.hpp"
#include "runner/stimuli/model_library.hpp"
#include "runner/trial_loop/trial_loop.hpp"
namespace tapstudy::runner {
// A trial ended by a fault; it is stored, and the force is off. The fault may have occurred after
// the answer.
struct Interruption {
  int trial{};
  core::TickFault fault{};
  bool is_answered{};
};
std::string to_text(const Interruption& interruption);

// Takes one participant through a schedule, trial by trial: builds its stimuli, renders them while
// the participant explores, and stores the complete trial.
class TrialEngine {
 public:
  TrialEngine(const protocols::Protocol& protocol, ModelLibrary& models, TrialLoop& trial_loop,
              Participant& participant, results::Recorder& recorder)
      : protocol_{protocol},
        models_{models},
        trial_loop_{trial_loop},
        participant_{participant},
        recorder_{recorder} {}

  // Runs the trials not in `done`, adding each, until all are done or a fault ends one; called
  // again, it repeats that one. Throws Stopped if the participant or the operator stops, StoreError
  // if a trial cannot be stored; the trial in progress is stored as interrupted, if possible.
  std::optional<Interruption> run(std::int64_t session_id, const protocols::Schedule& schedule,
                                  std::set<int>& done_trials);
  std::int64_t ticks() const noexcept { return ticks_; }  // rendered so far

 private:
  std::optional<Interruption> run_trial(std::int64_t session_id,
                                        const protocols::PlannedTrial& trial, int total);
  TrialPrompt prompt_of(const protocols::PlannedTrial& trial, int total) const;

  const protocols::Protocol& protocol_;
  ModelLibrary& models_;
  TrialLoop& trial_loop_;
  Participant& participant_;
  results::Recorder& recorder_;
  std::map<int, int> attempts_;  // by the trial's number
  std::int64_t ticks_{0};
};
}  // namespace tapstudy::runner
