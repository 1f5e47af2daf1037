#include "runner/experiments/order_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocols/block_order.hpp"
#include "protocols/ordering.hpp"
#include "protocols/schedule.hpp"
#include "runner/experiments/counted.hpp"
namespace tapstudy::runner {
using protocols::Block;
using protocols::Protocol;
namespace {
// Balance holds for whole sets of orders.
std::string williams_words(int of_orders, std::size_t participants) {
  const auto orders = static_cast<std::size_t>(of_orders);
  return participants % orders == 0
             ? ", in orders balanced for immediate sequence over participants (Williams 1949)"
             : fmt::format(
                   ", in orders of a balanced design (Williams 1949) that {} do not "
                   "complete, of {} orders",
                   counted(participants, "participant"), orders);
}

// " with no stimulus twice in a row"; "" without constraints.
std::string constraint_words(const protocols::OrderConstraints& constraints) {
  std::vector<std::string> limits;
  if (constraints.max_run > 0) {
    limits.push_back(
        constraints.max_run == 1
            ? "no stimulus twice in a row"
            : fmt::format("no stimulus more than {} times in a row", constraints.max_run));
  }
  if (constraints.min_distance > 1) {
    limits.push_back(fmt::format("presentations of a stimulus at least {} trials apart",
                                 constraints.min_distance));
  }
  return limits.empty() ? "" : fmt::format(" with {}", fmt::join(limits, " and "));
}
}  // namespace

std::string order_words(const Block& block, std::size_t participants) {
  if (!block.task->uses_order()) {
    return "";
  }
  switch (block.order) {
    case protocols::Order::listed:
      return ", in one order for all";
    case protocols::Order::shuffle:
      return ", in random order" + constraint_words(block.constraints);
    case protocols::Order::shuffle_within_repetition:
      return ", in an order that was random within each repetition" +
             constraint_words(block.constraints);
    case protocols::Order::williams:
      return williams_words(
          protocols::williams_rows(static_cast<int>(protocols::conditions(block))), participants);
  }
  return "";
}

std::string sequence_words(const Protocol& protocol, const std::string& who,
                           const std::vector<std::string>& blocks, std::size_t participants) {
  const protocols::BlockOrder& order = protocol.block_order;
  if (order.order == protocols::Order::listed) {
    return fmt::format("{} did {}. ", who, fmt::join(blocks, ", then "));
  }
  return fmt::format(
      "{} did {}, where '{}' exchanged their places among participants{}. ", who,
      fmt::join(blocks, ", then "), fmt::join(order.blocks, "', '"),
      order.order == protocols::Order::shuffle
          ? ", in random order"
          : williams_words(protocols::balanced_block_orders(protocol), participants));
}
}  // namespace tapstudy::runner
