#include "results/export/bids_events.hpp"

#include <algorithm>
#include <optional>

#include "results/export/tsv.hpp"
namespace tapstudy::results {
namespace {
struct Event {
  Row row;
  std::optional<std::string> block;
};
struct Session {
  std::string participant;
  std::int64_t id{};
  std::vector<Event> events;  // in their order
};

std::vector<Session> all_sessions(Store& store) {
  std::vector<Session> sessions;
  store.each_row(
      "SELECT session_id, participant_id, t_s, state, number, block FROM session_event "
      "JOIN v_sessions USING (session_id) "
      "LEFT JOIN (SELECT DISTINCT session_id, number, block FROM trial) USING (session_id, number) "
      "ORDER BY session_id, t_s, session_event.rowid",
      [&](Statement& row) {
        if (sessions.empty() || sessions.back().id != row.integer(0)) {
          sessions.push_back({row.text(1), row.integer(0), {}});
        }
        sessions.back().events.push_back({{row.real(2), std::monostate{}, row.text(3),
                                           row.is_null(4) ? Cell{} : Cell{row.integer(4)}},
                                          row.optional_text(5)});
      });
  return sessions;
}

// False if no event has a block.
bool fill_blocks(std::vector<Event>& events) {
  std::optional<std::string> block;
  for (auto event = events.rbegin(); event != events.rend(); ++event) {
    block = event->block ? event->block : block;
    event->block = block;
  }
  for (Event& event : events) {
    block = event.block ? event.block : block;
    event.block = block;
  }
  return block.has_value();
}

std::string header() {
  Row names;
  for (const DescribedColumn& known : event_columns()) {
    names.emplace_back(known.column.name);
  }
  return tsv_line(names);
}
}  // namespace

std::vector<DescribedColumn> event_columns() {
  return {{{"onset", CellType::real, "s", "Time from the session's begin"}},
          {{"duration", CellType::real, "s", "Missing: an event has none"}},
          {{"trial_type", CellType::text, "", "State that the session entered"}},
          {{"trial", CellType::integer, "", "Place of the trial in the participant's order"}}};
}

std::vector<BlockEvents> events_of_blocks(Store& store) {
  std::vector<BlockEvents> found;
  for (Session& session : all_sessions(store)) {
    if (!fill_blocks(session.events)) {
      continue;
    }
    const std::size_t first = found.size();
    for (const Event& event : session.events) {
      auto of =
          std::find_if(found.begin() + static_cast<std::ptrdiff_t>(first), found.end(),
                       [&](const BlockEvents& events) { return events.block == event.block; });
      if (of == found.end()) {
        found.push_back({session.participant, session.id, *event.block, header()});
        of = std::prev(found.end());
      }
      of->table += tsv_line(event.row);
    }
  }
  return found;
}
}  // namespace tapstudy::results
