#pragma once
#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "protocols/protocol.hpp"
#include "protocols/rig.hpp"
#include "protocols/schedule.hpp"
#include "results/store.hpp"
#include "runner/session/earlier_answers.hpp"
#include "runner/session/preflight.hpp"
namespace tapstudy::runner {
enum class Resume { no, yes };

// Participant and options of a session.
struct SessionRequest {
  std::string participant_id;
  results::Mode mode{results::Mode::real};
  Resume resume{Resume::no};
  std::optional<std::uint64_t> seed;  // of a new session; drawn if unset
  std::optional<int> order_index;     // of a new participant; the first free one if unset
  std::string language{"en"};         // of what the participant reads
};

struct BegunSession {
  results::SessionRow row;  // stored
  protocols::Schedule schedule;
  std::set<int> done;  // numbers of trials that are answered already
  EarlierAnswers earlier{};
  std::string resumed_since_utc{};  // when the session began that is gone on with; empty: none
};

// Starts a new session, or resumes the participant's last one with its trial order; seed and order
// are stored on return. Throws InvalidInput if the participant has a session and does not resume,
// has none to resume, or if this program would generate an order other than the stored one.
BegunSession begin_session(const SessionRequest& request, const protocols::Protocol& protocol,
                           const protocols::Rig& rig, const PreflightReport& preflight,
                           results::Store& store);
}  // namespace tapstudy::runner
