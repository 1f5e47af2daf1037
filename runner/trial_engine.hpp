#pragma once
#include <set>
#include <vector>

#include "protocols/schedule.hpp"
#include "results/recorder.hpp"
#include "runner/model_library.hpp"
#include "runner/participant.hpp"
#include "runner/presenter.hpp"
namespace tapstudy::runner {
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

  // Leaves out the trials that are done; returns the ticks rendered. Throws Stopped if the
  // participant or the operator stops, DeviceError if the device fails, StoreError if a trial
  // cannot be stored; in each case the trial that was under way is stored as interrupted, if it can
  // be.
  std::int64_t run(std::int64_t session_id, const protocols::Schedule& schedule,
                   const std::set<int>& done_trials = {});

 private:
  std::int64_t run_trial(std::int64_t session_id, const protocols::PlannedTrial& trial, int total);
  Presentation presentation_of(const protocols::PlannedTrial& trial, int total) const;

  const protocols::Protocol& protocol_;
  ModelLibrary& models_;
  Presenter& presenter_;
  Participant& participant_;
  results::Recorder& recorder_;
};
}  // namespace tapstudy::runner
