#pragma once
#include <cstdint>
#include <ctime>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "protocols/protocol.hpp"
#include "protocols/rig.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/store/store.hpp"
#include "runner/console/console.hpp"
#include "runner/session/devices/device_kind.hpp"
#include "runner/session/devices/diagnosis.hpp"
#include "runner/session/engine/between_trials.hpp"
namespace tapstudy::runner {
// Real-time performance, measured before a session's first trial and stored with it.
struct PreflightReport {
  std::string device;
  Diagnosis diagnosis;
};
// Takes half a second. Warns if the machine or the device is too slow for the loop. `sleep` is the
// outcome of asking the system not to sleep, if it was asked.
PreflightReport run_preflight(const protocols::Rig& rig, SessionDevice& device,
                              device::Nanoseconds period, const std::string& sleep);

enum class Resume { no, yes };

// Participant and options of a session.
struct SessionRequest {
  std::string participant_id;
  results::Mode mode{results::Mode::real};
  Resume resume{Resume::no};
  std::optional<std::uint64_t> seed;  // of a new session; drawn if unset
  std::optional<int> order_index;     // of a new participant; the first free one if unset
  std::string language{"en"};         // of what the participant reads
  std::string group{};  // of a new participant; empty: that of the participant's order index
  // Begins a session of a participant who comes again although it is too early or too late.
  bool at_any_time{false};
  std::function<std::time_t()> now{[] { return std::time(nullptr); }};
};

struct BegunSession {
  results::SessionRow row;  // stored
  protocols::Schedule schedule;
  std::set<int> done;  // numbers of trials that are answered already
  EarlierAnswers earlier{};
  std::string resumed_since_utc{};  // when the session began that is gone on with; empty: none
  std::string note{};               // of its time, where that is not the protocol's; empty: none
};

// Starts a new session, or resumes the participant's last one with its trial order; seed and order
// are stored on return. Where the protocol has sessions, who has done one does the next, whose
// trials are those of the same order. Throws InvalidInput if the participant has a session and does
// not resume, has none to resume, comes too early or too late, or if this program would generate an
// order other than the stored one.
BegunSession begin_session(const SessionRequest& request, const protocols::Protocol& protocol,
                           const protocols::Rig& rig, const PreflightReport& preflight,
                           results::Store& store);

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
  std::size_t without_answer{};                // their time was over
  std::optional<std::string> ending_answer{};  // to a form, by which the session has ended
  std::string session{};                       // of the protocol's; empty: it has none
  std::string next_session{};                  // and when it may begin; empty: none
};

// Takes the participant through all unanswered trials.
// After a device fault the operator may check the device and continue.
// Throws InvalidInput if the session cannot be run, DeviceError if the device fails permanently,
// StoreError if an answer cannot be stored, Stopped if the participant or the operator stops.
LiveOutcome run_live_session(const LiveSession& live);
}  // namespace tapstudy::runner
