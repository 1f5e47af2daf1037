// Groups of participants.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/error.hpp"
#include "protocols/reader/read_sections.hpp"
#include "protocols/schedule/groups.hpp"
#include "protocols/schedule/ordering.hpp"
#include "protocols/schedule/schedule.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;

// A block of several sessions is named by its name in each of them, or by its own for all.
bool is_named(const Block& block, const std::string& name) {
  return block.name == name || block.measure == name;
}

std::vector<std::string> names_of(const std::vector<Block>& blocks) {
  std::vector<std::string> names;
  std::ranges::transform(blocks, std::back_inserter(names), &Block::name);
  for (const Block& block : blocks) {
    if (std::ranges::find(names, block.measure) == names.end()) {
      names.push_back(block.measure);
    }
  }
  return names;
}

std::vector<Block> blocks_of(const Protocol& protocol, const Group& group) {
  std::vector<Block> own;
  std::ranges::copy_if(protocol.blocks, std::back_inserter(own),
                       [&](const Block& block) { return does(&group, block); });
  return own;
}

// In the order of the protocol's blocks, whatever the order in which they are named.
std::vector<std::string> in_file_order(const std::vector<Block>& all,
                                       const std::vector<std::string>& named) {
  std::vector<std::string> ordered;
  for (const Block& block : all) {
    if (std::ranges::any_of(named,
                            [&](const std::string& name) { return is_named(block, name); })) {
      ordered.push_back(block.name);
    }
  }
  return ordered;
}

// Blocks change places within a session, and sessions come in their own order.
void check_block_order(MapReader& reader, const Protocol& protocol,
                       const std::vector<std::string>& order) {
  std::map<std::string, std::string> last_of;  // by session
  std::size_t latest = 0;
  bool can_exchange = false;
  for (const std::string& name : order) {
    const Block& block = protocol.block(name);
    const auto session = std::ranges::find(protocol.sessions, block.session, &PlannedSession::name);
    const auto place = static_cast<std::size_t>(session - protocol.sessions.begin());
    if (block.measure == block.name && place < latest) {
      reader.reject("block_order",
                    fmt::format("'{}' is of session '{}', which comes earlier than that of the "
                                "blocks before it",
                                name, block.session));
      return;
    }
    latest = std::max(latest, place);
    can_exchange = can_exchange || !last_of.try_emplace(block.session, name).second;
  }
  if (!can_exchange) {
    reader.reject("block_order",
                  "names no two blocks of one session, within which they change places");
  }
}

std::vector<std::string> read_own_order(MapReader& reader, const Protocol& protocol,
                                        std::vector<Block> movable) {
  std::erase_if(movable, [](const Block& block) {
    return block.is_practice || block.is_fixed || !block.mixed_with.empty();
  });
  const std::size_t earlier_problems = reader.problems_in_file();
  const std::vector<std::string> named = reader.words(
      {"block_order",
       "names of the group's blocks that change places with one another: all of the group do "
       "these in this order, each with the practice before it; unset: as in the study's "
       "block_order"},
      "block of the group that may move (not practice, not fixed, not mixed with another)",
      names_of(movable), std::vector<std::string>{});
  std::vector<std::string> order;
  for (const std::string& name : named) {
    for (const Block& block : movable) {
      if (is_named(block, name)) {
        order.push_back(block.name);
      }
    }
  }
  if (!order.empty() && reader.problems_in_file() == earlier_problems) {
    check_block_order(reader, protocol, order);
  }
  return order;
}

// Why the block cannot be presented with these of its stimuli; empty: it can.
std::string why_not_with(const Block& own) {
  if (own.order == Order::williams && conditions(own) < 2) {
    return "a Williams order needs at least two stimuli";
  }
  if (own.criterion && planned_trials(own) < own.criterion->of_last) {
    return fmt::format("the block has {} trials with these, fewer than of_last of its criterion",
                       planned_trials(own));
  }
  try {
    core::Rng rng{1};
    ordered_conditions(own, rng, {});
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "";
}

void read_stimuli_of(MapReader& inner, const std::string& name, const std::vector<Block>& blocks,
                     Group& group) {
  std::vector<Block> named;
  std::ranges::copy_if(blocks, std::back_inserter(named),
                       [&](const Block& block) { return is_named(block, name); });
  for (const Block& block : named) {
    if (block.task == nullptr || !block.task->uses_order() || !block.task->has_correct_answer()) {
      inner.reject(
          name,
          "its stimuli are compared with one another within participants, who need all of them "
          "(allowed: in blocks of one stimulus a trial with a right answer, "
          "identification)");
      return;
    }
    if (group.stimuli.contains(block.name)) {
      inner.reject(name, fmt::format("is block '{}', whose stimuli are given already", block.name));
      return;
    }
    const std::size_t earlier_problems = inner.problems_in_file();
    group.stimuli[block.name] = inner.words(Key{name}, "stimulus of the block", block.stimuli);
    if (inner.problems_in_file() != earlier_problems) {
      return;  // the same of the others
    }
    if (const std::string why = why_not_with(block_of(&group, block)); !why.empty()) {
      inner.reject(name, why);
      return;
    }
  }
  if (named.empty()) {
    inner.reject(name, fmt::format("is no block that the group does (one of: {})",
                                   fmt::join(names_of(blocks), ", ")));
  }
}

Group read_group(MapReader& reader, const Protocol& protocol) {
  std::vector<std::string> all;
  std::ranges::transform(protocol.blocks, std::back_inserter(all), &Block::name);
  const std::size_t earlier_problems = reader.problems_in_file();
  Group group;
  group.name = reader.name({"name", "unique among the groups"});
  const std::string label = reader.text({"label", "what reports call it; unset: its name"}, "");
  group.label = label.empty() ? group.name : label;
  group.blocks = in_file_order(
      protocol.blocks,
      reader.words({"blocks",
                    "names of blocks: the group does these, in file order unless block_order "
                    "says otherwise; unset: all"},
                   "block", names_of(protocol.blocks), all));
  const bool counts = std::ranges::any_of(protocol.blocks, [&](const Block& block) {
    return !block.is_practice && does(&group, block);
  });
  if (reader.problems_in_file() == earlier_problems && !group.blocks.empty() && !counts) {
    reader.reject("blocks", "are practice alone: nothing that the group does would be reported");
  }
  // one mistake in the names of blocks is told once
  const bool are_known = reader.problems_in_file() == earlier_problems;
  const std::vector<Block> own = are_known ? blocks_of(protocol, group) : protocol.blocks;
  group.block_order = read_own_order(reader, protocol, own);
  reader.each_list(
      {"stimuli",
       "by block: of the block's stimuli those that the group is presented, in this order where "
       "the block's is listed; answers stay those of the block; unset: all of them"},
      Presence::optional,
      [&](MapReader& inner, const std::string& name) { read_stimuli_of(inner, name, own, group); });
  return group;
}

// Whether some participants are presented the stimulus, of those who do the block.
bool is_presented(const std::string& stimulus, const Block& block,
                  const std::vector<Group>& groups) {
  return std::ranges::any_of(groups, [&](const Group& group) {
    const std::vector<std::string> own = block_of(&group, block).stimuli;
    return does(&group, block) && std::ranges::find(own, stimulus) != own.end();
  });
}

// What is stated for all of them, and concerns none.
void check_are_for_some(MapReader& top, const Protocol& protocol) {
  const std::vector<Group>& groups = protocol.groups;
  if (protocol.block_order.order != Order::listed &&
      std::ranges::none_of(groups, [](const Group& group) { return group.block_order.empty(); })) {
    top.reject("block_order", "is of no group: each of them has its own");
  }
  for (const Block& block : protocol.blocks) {
    for (const std::string& stimulus : block.stimuli) {
      if (!is_presented(stimulus, block, groups)) {
        top.reject("groups", fmt::format("stimulus '{}' of block '{}' is presented to none of them",
                                         stimulus, block.name));
      }
    }
  }
}

void check_groups(MapReader& top, const Protocol& protocol, bool are_whole) {
  const std::vector<Group>& groups = protocol.groups;
  const bool are_given = top.has("groups");
  top.check("groups", !are_given || groups.size() > 1, R"({"minItems": 2})",
            "must be two or more (or leave the key out)");
  for (const Block& block : protocol.blocks) {
    const bool is_done =
        std::ranges::any_of(groups, [&](const Group& group) { return does(&group, block); });
    if (are_whole && groups.size() > 1 && !is_done) {
      top.reject("groups", fmt::format("block '{}' is in none of them", block.name));
      return;
    }
  }
  if (are_whole && groups.size() > 1) {
    check_are_for_some(top, protocol);
  }
}
}  // namespace

void read_groups(MapReader& top, Protocol& protocol) {
  const std::size_t earlier_problems = top.problems_in_file();
  top.list({"groups",
            "of participants, each of whom is in one: of each run of as many participants as there "
            "are groups one is in each, in an order that counterbalancing_seed draws, unless `run "
            "--group` says which; at least two; unset: none"},
           Presence::optional, [&](MapReader& reader) {
             Group group = read_group(reader, protocol);
             check_name_is_new(reader, protocol.groups, group.name, "group");
             protocol.groups.push_back(std::move(group));
           });
  check_groups(top, protocol, top.problems_in_file() == earlier_problems);
}
}  // namespace tapstudy::protocols
