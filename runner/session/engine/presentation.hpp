#pragma once
#include <cstdint>
#include <exception>
#include <functional>
#include <optional>

#include "protocols/schedule/schedule.hpp"
#include "runner/session/engine/session_states.hpp"
#include "runner/session/engine/trial_record.hpp"
#include "runner/session/operators/operator.hpp"
#include "runner/session/participants/participant.hpp"
#include "runner/session/stimuli/model_library.hpp"
#include "runner/session/trial_loop/real_plates.hpp"
#include "runner/session/trial_loop/trial_loop.hpp"
namespace tapstudy::runner {
// The outcome of presenting a trial once.
struct Presentation {
  TrialResult result{};
  std::optional<Answer> answer{};
  bool is_answered_in_a_stall{};
  bool is_timed_out{};
  std::optional<TrialRequest> request{};  // the operator's, that ended it
  bool is_paused{};                       // by the operator, which ended it
  std::exception_ptr failure{};           // thrown again once the trial is stored
};

// The people and things that a session is made of.
struct SessionParts {
  const protocols::Protocol& protocol;
  ModelLibrary& models;
  TrialLoop& trial_loop;
  RealPlates& real_plates;
  Participant& participant;
  Operator& by;
  SessionStates& states;
  std::uint64_t seed{};  // of the session
  // Told of a trial's events that are not found in its trace, as they happen; may be empty.
  std::function<void(const results::EventRow& event, int trial)> tell{};
  const core::ActuatorOutput* actuator{};  // nullptr: the device renders alone
};

// Builds the trial's stimuli and renders them until the participant has given an answer that
// counts, time is up, the operator or a fault ends it, or the participant stops.
Presentation present(const TrialInView& trial, const SessionParts& parts);
}  // namespace tapstudy::runner
