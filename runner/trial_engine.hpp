#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/tick_fault.hpp"
#include "protocols/schedule.hpp"
#include "results/recorder.hpp"
#include "runner/model_library.hpp"
#include "runner/participant.hpp"
#include "runner/presenter.hpp"
namespace tapstudy::runner {
// A trial that a fault ended; it is stored, and no force is on. The fault may have come when the
// answer was given already.
struct Interruption {
  int trial{};
  core::TickFault fault{};
  bool is_answered{};
};
std::string to_text(const Interruption& interruption);

// Takes one participant through a schedule, trial by trial: build the scene, render it while the
// participant explores, store the trial whole.
class TrialEngine {
 public:
  TrialEngine(const protocols::Protocol& protocol, ModelLibrary& models, Presenter& presenter,
              Participant& participant, results::Recorder& recorder)
      : protocol_{protocol},
        models_{models},
        presenter_{presenter},
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
  Presentation presentation_of(const protocols::PlannedTrial& trial, int total) const;

  const protocols::Protocol& protocol_;
  ModelLibrary& models_;
  Presenter& presenter_;
  Participant& participant_;
  results::Recorder& recorder_;
  std::map<int, int> attempts_;  // by the trial's number
  std::int64_t ticks_{0};
};
}  // namespace tapstudy::runner
