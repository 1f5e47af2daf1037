#include "protocols/schedule/groups.hpp"

#include <algorithm>
#include <iterator>

#include "protocols/schedule/ordering.hpp"
namespace tapstudy::protocols {
const Group* group_of(const Protocol& protocol, int order_index) {
  if (protocol.groups.empty()) {
    return nullptr;
  }
  const std::uint64_t seed =
      core::derived_seed(protocol.counterbalancing_seed, core::Purpose::groups);
  const int group =
      balanced_sequence(static_cast<int>(protocol.groups.size()), {order_index, seed});
  return &protocol.groups[static_cast<std::size_t>(group)];
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
