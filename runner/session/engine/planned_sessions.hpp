#pragma once
#include <ctime>
#include <optional>
#include <set>
#include <string>

#include "protocols/protocol.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/rows.hpp"
namespace tapstudy::runner {
// Whether a later session has trials in the schedule.
bool comes_again(const protocols::PlannedSession& session, const protocols::Protocol& protocol,
                 const protocols::Schedule& schedule);

// The session that a participant does next who has not done those before, or comes again after
// `earlier`. Throws InvalidInput if that one has trials left, or none has.
const protocols::PlannedSession& next_session(const protocols::Protocol& protocol,
                                              const protocols::Schedule& schedule,
                                              const std::set<int>& done,
                                              const results::SessionRow* earlier);

// "24 to 48 h", "at least 2 days": since the session before began; empty: whenever it is.
std::string described_interval(const protocols::PlannedSession& session);

// Why a session may not begin now, so long after the one before, and when it may; unset: it may.
std::optional<std::string> too_early_or_late(const protocols::PlannedSession& session,
                                             const results::SessionRow& earlier, std::time_t now);
}  // namespace tapstudy::runner
