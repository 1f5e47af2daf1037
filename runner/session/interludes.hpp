#pragma once
#include <map>
#include <string>

#include "protocols/protocol.hpp"
#include "protocols/schedule.hpp"
#include "runner/participants/participant.hpp"
#include "runner/session/session_states.hpp"
namespace tapstudy::runner {
// What comes between the trials of a session: instructions, and rests after every so many trials.
class Interludes {
 public:
  Interludes(const protocols::Protocol& protocol, Participant& participant, SessionStates& states)
      : protocol_{protocol}, participant_{participant}, states_{states} {}
  // Throws Stopped if the participant stops.
  void before(const protocols::PlannedTrial& trial);

 private:
  void read(const std::string& text, const std::string& whose);
  const protocols::Protocol& protocol_;
  Participant& participant_;
  SessionStates& states_;
  bool has_begun_{false};
  std::string block_;
  int since_rest_{0};  // trials
};
}  // namespace tapstudy::runner
