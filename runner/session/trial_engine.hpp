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
// A trial that a fault ended; it is stored, and no force is on. The fault may have come when the
// answer was given already.
struct Interruption {
  int trial{};
  core::TickFault fault{};
  bool is_answered{};
};
std::string to_text(const Interruption& interruption);

// Takes one participant through a schedule, trial by trial: build its stimuli, render them while
// the participant explores, store the trial whole.
class TrialEngine {
 public:
  TrialEngine(const protocols::Protocol& protocol, ModelLibrary& models, TrialLoop& trial_loop,
              Participant& participant, results::Recorder& recorder)
      : protocol_{protocol},
        models_{models},
        trial_loop_{trial_loop},
        participant_{participant},
        recorder_{recorder} {}

  // Takes the trials that are not done, and adds them to those that are, until all are or a fault
  // ends one; called again, it takes that one again. Throws Stopped if the participant or the
  // operator stops, StoreError if a trial cannot be stored; the trial that was under way is stored
  // as interrupted, if it can be.
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
