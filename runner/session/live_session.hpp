#pragma once
#include <optional>
#include <string>

#include "protocols/protocol.hpp"
#include "protocols/rig.hpp"
#include "runner/console/console.hpp"
#include "runner/session/begin_session.hpp"
namespace tapstudy::runner {
// One participant, at the terminal or at a page, on the rig's device, in real time.
struct LiveSession {
  const protocols::Protocol& protocol;
  std::string protocol_file;
  const protocols::Rig& rig;
  std::string directory;  // of the study
  SessionRequest request;
  std::optional<ConsoleRequest> console;  // else at the terminal
};

struct LiveOutcome {
  std::size_t answered{};
  std::size_t without_answer{};  // their time was over
};

// Takes the participant through all unanswered trials.
// After a device fault the operator may check the device and continue.
// Throws InvalidInput if the session cannot be run, DeviceError if the device fails permanently,
// StoreError if an answer cannot be stored, Stopped if the participant or the operator stops.
LiveOutcome run_live_session(const LiveSession& live);
}  // namespace tapstudy::runner
