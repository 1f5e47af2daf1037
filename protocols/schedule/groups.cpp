#include "protocols/schedule/groups.hpp"

#include <algorithm>
#include <iterator>

#include "protocols/schedule/ordering.hpp"
namespace tapstudy::protocols {
std::size_t place_of_group(std::uint64_t counterbalancing_seed, std::size_t groups,
                           int order_index) {
  const std::uint64_t seed = core::derived_seed(counterbalancing_seed, core::Purpose::groups);
  return static_cast<std::size_t>(balanced_sequence(static_cast<int>(groups), {order_index, seed}));
}

const Group* group_of(const Protocol& protocol, int order_index) {
  return protocol.groups.empty()
             ? nullptr
             : &protocol.groups[place_of_group(protocol.counterbalancing_seed,
                                               protocol.groups.size(), order_index)];
}

int index_in_group(const Protocol& protocol, int order_index) {
  return index_in_group(protocol.groups.size(), order_index);
}

int index_in_group(std::size_t groups, int order_index) {
  return groups == 0 ? order_index : order_index / static_cast<int>(groups);
}

bool does(const Group* group, const Block& block) {
  return group == nullptr || std::ranges::find(group->blocks, block.name) != group->blocks.end();
}

Block block_of(const Group* group, const Block& block) {
  Block own = block;
  if (group != nullptr && group->stimuli.contains(block.name)) {
    own.stimuli = group->stimuli.at(block.name);
  }
  return own;
}

std::map<std::string, int> right_answers(const Block& block) {
  std::map<std::string, int> counts;
  for (const std::string& stimulus : block.stimuli) {
    const auto right = block.right_response.find(stimulus);
    ++counts[right == block.right_response.end() ? stimulus : right->second];
  }
  return counts;
}

int members(const Protocol& protocol, const Group* group, int participants) {
  int count = 0;
  for (int i = 0; i < participants; ++i) {
    count += group == nullptr || group_of(protocol, i) == group ? 1 : 0;
  }
  return count;
}

int participants_of(const Protocol& protocol, const Block& block, int participants) {
  int count = 0;
  for (int i = 0; i < participants; ++i) {
    count += does(group_of(protocol, i), block) ? 1 : 0;
  }
  return count;
}

std::vector<const Group*> groups_of(const Protocol& protocol) {
  if (protocol.groups.empty()) {
    return {nullptr};
  }
  std::vector<const Group*> all;
  std::ranges::transform(protocol.groups, std::back_inserter(all),
                         [](const Group& group) { return &group; });
  return all;
}
}  // namespace tapstudy::protocols
