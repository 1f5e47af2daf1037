#pragma once
#include <string>

#include "protocols/protocol.hpp"
#include "protocols/rig.hpp"
#include "runner/session/begin_session.hpp"
namespace tapstudy::runner {
// One participant at the terminal, on the rig's device, in real time.
struct LiveSession {
  const protocols::Protocol& protocol;
  std::string protocol_file;
  const protocols::Rig& rig;
  std::string directory;  // of the study
  SessionRequest request;
};

// Takes the participant through all trials that are not answered yet, and returns how many the
// session has. After a fault of the device the operator is offered to see to it and go on.
// Throws InvalidInput for what cannot be run, DeviceError if the device fails for good, StoreError
// if an answer cannot be stored, Stopped if the participant or the operator stops.
std::size_t run_live_session(const LiveSession& live);
}  // namespace tapstudy::runner
