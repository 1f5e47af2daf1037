#include "runner/studies/session_times.hpp"

#include <fmt/format.h>

#include <ctime>
#include <map>
#include <optional>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "runner/session/engine/session_row.hpp"
namespace tapstudy::runner {
namespace {
std::map<std::int64_t, double> lengths_of_sessions(results::Store& store) {
  std::map<std::int64_t, double> lengths;
  store.each_row("SELECT session_id, max(t_s) FROM session_event GROUP BY session_id",
                 [&](results::Statement& row) { lengths[row.integer(0)] = row.real(1); });
  return lengths;
}

std::optional<std::time_t> begin_of(const results::SessionRow& session) {
  try {
    return time_from(session.started_utc);
  } catch (const core::InvalidInput&) {
    return std::nullopt;
  }
}
}  // namespace

CheckedTimes checked_session_times(results::Store& store) {
  constexpr double begin_rounding_s = 2.0;  // begins are whole seconds
  CheckedTimes checked;
  const std::map<std::int64_t, double> lengths = lengths_of_sessions(store);
  struct Before {
    const results::SessionRow* session{};
    double end_s{};  // since 1970
  };
  std::map<std::string, Before> before;  // of each participant
  const std::vector<results::SessionRow> sessions = store.sessions();
  for (const results::SessionRow& session : sessions) {
    const auto began = begin_of(session);
    if (!began) {
      checked.wrong.push_back(fmt::format("session {}: {} is no time at which it began", session.id,
                                          core::quoted_name(session.started_utc)));
      continue;
    }
    if (session.mode == results::Mode::simulated) {
      continue;  // whose seconds pass sooner
    }
    const auto length = lengths.find(session.id);
    const double begin_s = static_cast<double>(*began);
    Before& last = before[session.participant_id];
    if (last.session != nullptr && begin_s < last.end_s - begin_rounding_s) {
      checked.unlikely.push_back(fmt::format(
          "session {} of {} began at {}, {:.0f} s before session {} of the same participant was "
          "over: the clock was set back in between, or one of the two rows is wrong",
          session.id, core::quoted_name(session.participant_id), session.started_utc,
          last.end_s - begin_s, last.session->id));
    }
    last = {&session, begin_s + (length == lengths.end() ? 0.0 : length->second)};
  }
  return checked;
}
}  // namespace tapstudy::runner
