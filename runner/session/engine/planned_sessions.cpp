#include "runner/session/engine/planned_sessions.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "runner/session/engine/session_row.hpp"
namespace tapstudy::runner {
using protocols::PlannedSession;
using protocols::PlannedTrial;
namespace {
constexpr double seconds_per_hour = 3600.0;
constexpr double hours_per_day = 24.0;

bool has_open_trials(const PlannedSession& session, const protocols::Protocol& protocol,
                     const protocols::Schedule& schedule, const std::set<int>& done) {
  return std::ranges::any_of(schedule, [&](const PlannedTrial& trial) {
    return protocol.block(trial.block).session == session.name && !done.contains(trial.number);
  });
}

// Of whose trials in the schedule some are not done; nullptr: there is none.
const PlannedSession* first_open_session(const protocols::Protocol& protocol,
                                         const protocols::Schedule& schedule,
                                         const std::set<int>& done) {
  const auto open = std::ranges::find_if(protocol.sessions, [&](const PlannedSession& session) {
    return has_open_trials(session, protocol, schedule, done);
  });
  return open == protocol.sessions.end() ? nullptr : &*open;
}

// Of a time: in hours up to three days, then in days.
std::string described_time(double seconds) {
  const double hours = seconds / seconds_per_hour;
  return hours <= 3.0 * hours_per_day ? fmt::format("{:.3g} h", hours)
                                      : fmt::format("{:.4g} days", hours / hours_per_day);
}

std::string utc(std::time_t began, double later_s) {
  return fmt::format("{:%F %R} UTC", fmt::gmtime(began + static_cast<std::time_t>(later_s)));
}
}  // namespace

bool comes_again(const PlannedSession& session, const protocols::Protocol& protocol,
                 const protocols::Schedule& schedule) {
  const auto at = std::ranges::find(protocol.sessions, session.name, &PlannedSession::name);
  return at != protocol.sessions.end() &&
         std::any_of(at + 1, protocol.sessions.end(), [&](const PlannedSession& later) {
           return has_open_trials(later, protocol, schedule, {});
         });
}

const PlannedSession& next_session(const protocols::Protocol& protocol,
                                   const protocols::Schedule& schedule, const std::set<int>& done,
                                   const results::SessionRow* earlier) {
  const PlannedSession* const open = first_open_session(protocol, schedule, done);
  const std::string who = earlier == nullptr ? "" : earlier->participant_id;
  if (open == nullptr) {
    throw core::InvalidInput{fmt::format(
        "participant '{}' has completed every session of the study (choose another id)", who)};
  }
  if (earlier == nullptr) {
    return *open;
  }
  const PlannedSession* const before = protocol.find_session(earlier->planned_session.value_or(""));
  if (before == nullptr || open <= before) {
    throw core::InvalidInput{
        fmt::format("participant '{}' is in this study already, with trials left in session '{}' "
                    "(go on with --resume, or choose another id)",
                    who, open->name)};
  }
  return *open;
}

std::string described_interval(const PlannedSession& session) {
  const auto& least = session.min_since_last_s;
  const auto& most = session.max_since_last_s;
  if (least && most) {
    return fmt::format("{} to {}", described_time(*least), described_time(*most));
  }
  return least  ? "at least " + described_time(*least)
         : most ? "at most " + described_time(*most)
                : "";
}

std::optional<std::string> too_early_or_late(const PlannedSession& session,
                                             const results::SessionRow& earlier, std::time_t now) {
  const std::time_t began = time_from(earlier.started_utc);
  const double since_s = std::difftime(now, began);
  const bool is_early = since_s < session.min_since_last_s.value_or(0.0);
  const bool is_late = session.max_since_last_s && since_s > *session.max_since_last_s;
  if (!is_early && !is_late) {
    return std::nullopt;
  }
  const double bound_s =
      is_early ? session.min_since_last_s.value_or(0.0) : *session.max_since_last_s;
  const std::string from =
      session.min_since_last_s ? " from " + utc(began, *session.min_since_last_s) : "";
  const std::string until =
      session.max_since_last_s ? " until " + utc(began, *session.max_since_last_s) : "";
  return fmt::format(
      "session '{}' may begin{}{}{}, {} after session '{}' began ({}): it is {} too "
      "{}",
      session.name, from, from.empty() || until.empty() ? "" : " and", until,
      described_interval(session), earlier.planned_session.value_or(""), utc(began, 0.0),
      described_time(std::abs(since_s - bound_s)), is_early ? "early" : "late");
}
}  // namespace tapstudy::runner
