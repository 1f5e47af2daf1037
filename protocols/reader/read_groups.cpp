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
  group.blocks = in_file_order(
      protocol.blocks,
      reader.words({"blocks",
                    "names of blocks: the group does these, in file order unless block_order "
                    "says otherwise; unset: all"},
                   "block", names, all));
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
