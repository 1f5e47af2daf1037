// The sessions of a participant who comes more than once.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "protocols/reader/read_sections.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;
constexpr double seconds_per_hour = 3600.0;
constexpr double seconds_per_day = 86400.0;
constexpr double most_days = 3653.0;

// The bound, in hours or in days.
std::optional<double> read_bound_s(MapReader& reader, const std::string& which,
                                   const std::string& unset) {
  const std::string hours = which + "_hours_since_last";
  const std::string days = which + "_days_since_last";
  const std::string meaning = " the session before began, " + unset;
  if (reader.has(hours)) {
    reader.refuse(days, "stands beside " + hours + ": one of them says it");
    return seconds_per_hour * reader.number({hours, which + " hours since" + meaning},
                                            Range::positive(24.0 * most_days));
  }
  if (reader.has(days)) {
    return seconds_per_day * reader.number({days, which + " days of 24 h since" + meaning},
                                           Range::positive(most_days));
  }
  return std::nullopt;
}

PlannedSession read_session(MapReader& reader, const Protocol& protocol) {
  std::vector<std::string> all;
  for (const Block& block : protocol.blocks) {
    all.push_back(block.name);
  }
  PlannedSession session;
  session.name = reader.name({"name", "unique among the sessions; stored with each"});
  session.blocks = reader.words(
      {"blocks",
       "names of blocks, in file order unless block_order says otherwise, which moves them within "
       "the session. One of several sessions is measured again in each: in data and in the other "
       "keys it is called BLOCK.SESSION"},
      "block", all);
  session.min_since_last_s = read_bound_s(reader, "min", "whichever that was; unset: 0");
  session.max_since_last_s = read_bound_s(reader, "max", "not below min; unset: no limit");
  if (session.max_since_last_s.value_or(session.min_since_last_s.value_or(0.0)) <
      session.min_since_last_s.value_or(0.0)) {
    reader.reject(
        "ends before it begins: the longest time since the last session is shorter than "
        "the shortest");
  }
  return session;
}

bool has(const PlannedSession& session, const Block& block) {
  return std::ranges::find(session.blocks, block.name) != session.blocks.end();
}

// A block for each session that it is in, session by session.
std::vector<Block> blocks_of_sessions(const std::vector<Block>& blocks,
                                      std::vector<PlannedSession>& sessions) {
  const std::vector<PlannedSession> as_written = sessions;
  std::vector<Block> all;
  for (PlannedSession& session : sessions) {
    std::vector<std::string> names;
    for (Block block : blocks) {
      if (!has(session, block)) {
        continue;
      }
      const bool is_shared = std::ranges::count_if(as_written, [&](const PlannedSession& one) {
                               return has(one, block);
                             }) > 1;
      block.session = session.name;
      block.name += is_shared ? "." + session.name : "";
      names.push_back(block.name);
      all.push_back(std::move(block));
    }
    session.blocks = names;
  }
  std::ranges::copy_if(blocks, std::back_inserter(all), [&](const Block& block) {  // an error
    return std::ranges::none_of(as_written,
                                [&](const PlannedSession& one) { return has(one, block); });
  });
  return all;
}

void check_sessions(MapReader& top, const Protocol& protocol) {
  for (const Block& block : protocol.blocks) {
    if (std::ranges::none_of(protocol.sessions,
                             [&](const PlannedSession& session) { return has(session, block); })) {
      top.reject("sessions", fmt::format("block '{}' is in none of them", block.name));
    }
  }
  for (const PlannedSession& session : protocol.sessions) {
    if (std::ranges::all_of(protocol.blocks, [&](const Block& block) {
          return block.is_practice || !has(session, block);
        })) {
      top.reject("sessions", fmt::format("'{}' is practice alone", session.name));
    }
  }
}

void check_names(MapReader& top, const std::vector<Block>& blocks) {
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto has_same_name = [&](const Block& other) { return other.name == blocks[i].name; };
    if (!is_name(blocks[i].name)) {
      top.reject("sessions",
                 fmt::format("'{}' is longer than a name may be (64 letters)", blocks[i].name));
    } else if (std::any_of(blocks.begin(), blocks.begin() + static_cast<std::ptrdiff_t>(i),
                           has_same_name)) {
      top.reject("sessions", fmt::format("two blocks would be called '{}'", blocks[i].name));
    }
  }
}
}  // namespace

void read_planned_sessions(MapReader& top, Protocol& protocol) {
  const std::size_t earlier_problems = top.problems_in_file();
  top.list(
      {"sessions",
       "the times that each participant comes, in order, each with its blocks; at least two; "
       "unset: once"},
      Presence::optional, [&](MapReader& reader) {
        PlannedSession session = read_session(reader, protocol);
        check_name_is_new(reader, protocol.sessions, session.name, "session");
        if (protocol.sessions.empty() && (session.min_since_last_s || session.max_since_last_s)) {
          reader.reject("has a time since the last session, but is the first");
        }
        protocol.sessions.push_back(std::move(session));
      });
  top.check("sessions", !top.has("sessions") || protocol.sessions.size() > 1, R"({"minItems": 2})",
            "must be two or more (or leave the key out)");
  if (protocol.sessions.size() > 1 && top.problems_in_file() == earlier_problems) {
    check_sessions(top, protocol);
    protocol.blocks = blocks_of_sessions(protocol.blocks, protocol.sessions);
    check_names(top, protocol.blocks);
  }
}
}  // namespace tapstudy::protocols
