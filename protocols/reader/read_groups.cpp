// Groups of participants.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "protocols/reader/read_sections.hpp"
#include "protocols/schedule/groups.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;

// In the order of the protocol's blocks, whatever the order in which they are named; a block of
// several sessions by its name in each of them, or by its own for all.
std::vector<std::string> in_file_order(const std::vector<Block>& all,
                                       const std::vector<std::string>& named) {
  std::vector<std::string> ordered;
  for (const Block& block : all) {
    if (std::ranges::find(named, block.name) != named.end() ||
        std::ranges::find(named, block.measure) != named.end()) {
      ordered.push_back(block.name);
    }
  }
  return ordered;
}

// As they are named.
std::vector<std::string> in_order_named(const std::vector<Block>& all,
                                        const std::vector<std::string>& named) {
  std::vector<std::string> ordered;
  for (const std::string& name : named) {
    std::ranges::copy(in_file_order(all, {name}), std::back_inserter(ordered));
  }
  return ordered;
}

// What is mixed is one thing after which the next one comes.
bool are_mixed_ones_together(const Protocol& protocol, const std::vector<std::string>& order) {
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t k = i + 2; k < order.size(); ++k) {
      const Block& one = protocol.block(order[i]);
      if (protocol.are_mixed(one, protocol.block(order[k])) &&
          !protocol.are_mixed(one, protocol.block(order[k - 1]))) {
        return false;
      }
    }
  }
  return true;
}

void read_own_order(MapReader& reader, const Protocol& protocol,
                    const std::vector<std::string>& named, Group& group) {
  const bool is_own = reader.one_of<bool>(
      {"block_order",
       "as_named: the group does its blocks in the order in which they are named here, whatever "
       "the protocol's block_order does with those of other groups"},
      {{"as_named", true}, {"as_protocol", false}}, "as_protocol");
  if (!is_own) {
    return;
  }
  if (!reader.has("blocks")) {
    reader.reject("block_order", "is as_named, and 'blocks' names none");
    return;
  }
  group.own_order = in_order_named(protocol.blocks, named);
  if (!are_mixed_ones_together(protocol, group.own_order)) {
    reader.reject("blocks", "name another block between two that are mixed with each other");
  }
}

Group read_group(MapReader& reader, const Protocol& protocol) {
  std::vector<std::string> all;
  std::ranges::transform(protocol.blocks, std::back_inserter(all), &Block::name);
  std::vector<std::string> names = all;
  for (const Block& block : protocol.blocks) {
    if (std::ranges::find(names, block.measure) == names.end()) {
      names.push_back(block.measure);
    }
  }
  const std::size_t earlier_problems = reader.problems_in_file();
  Group group;
  group.name = reader.name({"name", "unique among the groups"});
  const std::string label = reader.text({"label", "what reports call it; unset: its name"}, "");
  group.label = label.empty() ? group.name : label;
  const std::vector<std::string> named =
      reader.words({"blocks",
                    "names of blocks: the group does these, in file order unless block_order "
                    "says otherwise; unset: all"},
                   "block", names, all);
  group.blocks = in_file_order(protocol.blocks, named);
  read_own_order(reader, protocol, named, group);
  const bool counts = std::ranges::any_of(protocol.blocks, [&](const Block& block) {
    return !block.is_practice && does(&group, block);
  });
  if (reader.problems_in_file() == earlier_problems && !group.blocks.empty() && !counts) {
    reader.reject("blocks", "are practice alone: nothing that the group does would be reported");
  }
  return group;
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
    }
  }
}
}  // namespace

void read_groups(MapReader& top, Protocol& protocol) {
  const std::size_t earlier_problems = top.problems_in_file();
  top.list(
      {"groups",
       "of participants, each of whom is in one: of each run of as many participants as there "
       "are groups one is in each, in an order that counterbalancing_seed draws, unless `run "
       "--group` says which; at least two; unset: none"},
      Presence::optional, [&](MapReader& reader) {
        Group group = read_group(reader, protocol);
        if (std::ranges::find(protocol.groups, group.name, &Group::name) != protocol.groups.end()) {
          reader.reject("name", fmt::format("'{}' is the name of an earlier group", group.name));
        }
        protocol.groups.push_back(std::move(group));
      });
  check_groups(top, protocol, top.problems_in_file() == earlier_problems);
}
}  // namespace tapstudy::protocols
