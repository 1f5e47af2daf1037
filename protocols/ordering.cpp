#include "protocols/ordering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <span>

#include "core/error.hpp"
#include "protocols/constrained_order.hpp"
namespace tapstudy::protocols {
namespace {
std::vector<OrderedCondition> listed(const Block& block) {
  std::vector<OrderedCondition> all;
  all.reserve(static_cast<std::size_t>(block.repetitions) * conditions(block));
  for (int repetition = 1; repetition <= block.repetitions; ++repetition) {
    for (std::size_t i = 0; i < conditions(block); ++i) {
      all.push_back({i, repetition});
    }
  }
  return all;
}

std::vector<OrderedCondition> williams(const Block& block,
                                       const Counterbalancing& counterbalancing) {
  const int n = static_cast<int>(conditions(block));
  const int rows = williams_rows(n);
  const int groups = williams_sequences(n, block.repetitions) / rows;
  const std::uint64_t group_seed =
      core::derived_seed(counterbalancing.seed, core::Purpose::square_order);
  const int group = balanced_sequence(groups, {counterbalancing.order_index / rows, group_seed});
  const int row = balanced_sequence(rows, counterbalancing);
  std::vector<OrderedCondition> all;
  for (const int i : williams_sequence(n, block.repetitions, group * rows + row)) {
    all.push_back({static_cast<std::size_t>(i), 1 + static_cast<int>(all.size()) / n});
  }
  return all;
}

// By how often each has been presented, whatever its place in a list was.
void count_repetitions(std::vector<OrderedCondition>& all, std::size_t conditions) {
  std::vector<int> seen(conditions, 0);
  for (OrderedCondition& next : all) {
    next.repetition = ++seen[next.condition];
  }
}

std::vector<OrderedCondition> shuffled(const Block& block, core::Rng& rng) {
  std::vector<OrderedCondition> all = listed(block);
  const std::size_t size = conditions(block);
  if (block.order == Order::shuffle) {
    rng.shuffle(all);
    count_repetitions(all, size);
    return all;
  }
  for (std::size_t first = 0; first < all.size(); first += size) {
    rng.shuffle(std::span{all}.subspan(first, size));
  }
  return all;
}

// Counting takes longer than drawing, and reports draw many times.
ConstrainedOrders& orders_of(const Block& block) {
  using Key = std::array<std::size_t, 5>;
  thread_local std::map<Key, ConstrainedOrders> known;
  const Key key{conditions(block), static_cast<std::size_t>(block.repetitions),
                static_cast<std::size_t>(block.constraints.max_run),
                static_cast<std::size_t>(block.constraints.min_distance),
                static_cast<std::size_t>(block.order)};
  return known.try_emplace(key, block).first->second;
}

std::vector<OrderedCondition> constrained(const Block& block, core::Rng& rng) {
  ConstrainedOrders& orders = orders_of(block);
  const auto count = orders.count();
  if (!count || *count == 0.0) {
    throw core::InvalidInput{fmt::format(
        "block '{}': {}", block.name,
        count ? "no order satisfies its constraints"
              : "there are too many presentations to draw a constrained order (split the block)")};
  }
  std::vector<OrderedCondition> all;
  for (const std::size_t i : orders.draw(rng)) {
    all.push_back({i});
  }
  count_repetitions(all, conditions(block));
  return all;
}
}  // namespace

int balanced_sequence(int sequences, const Counterbalancing& counterbalancing) {
  std::vector<int> order(static_cast<std::size_t>(sequences));
  std::iota(order.begin(), order.end(), 0);
  const auto run = static_cast<std::uint64_t>(counterbalancing.order_index / sequences);
  core::Rng rng{core::derived_seed(counterbalancing.seed, core::Purpose::counterbalancing, run)};
  rng.shuffle(order);
  return order.at(static_cast<std::size_t>(counterbalancing.order_index % sequences));
}

std::size_t conditions(const Block& block) {
  return block.stimuli.size() * (block.on_axis ? block.on_axis->values.size() : 1);
}

std::size_t stimulus_of(const Block& block, std::size_t condition) {
  return block.on_axis ? condition / block.on_axis->values.size() : condition;
}

AxisValues values_of(const Block& block, std::size_t condition) {
  if (!block.on_axis) {
    return {};
  }
  const std::vector<double>& values = block.on_axis->values;
  return {{block.on_axis->axis, values[condition % values.size()]}};
}

std::vector<OrderedCondition> ordered_conditions(const Block& block, const Draw& draw) {
  core::Rng rng{
      core::derived_seed(draw.participant_seed, core::Purpose::schedule, draw.block_index)};
  return ordered_conditions(block, rng, {draw.order_index, draw.counterbalancing_seed});
}

std::vector<OrderedCondition> ordered_conditions(const Block& block, core::Rng& rng,
                                                 const Counterbalancing& counterbalancing) {
  if (block.order == Order::williams) {
    return williams(block, counterbalancing);
  }
  if (block.order == Order::listed) {
    return listed(block);
  }
  return block.constraints.are_any() ? constrained(block, rng) : shuffled(block, rng);
}

std::vector<int> williams_row(int n, int row) {
  const int shift = row % n;
  std::vector<int> conditions;
  for (int place = 0; place < n; ++place) {
    const int zigzag = place % 2 == 1 ? (place + 1) / 2 : n - place / 2;
    conditions.push_back((zigzag + shift) % n);
  }
  const bool is_mirrored = row % williams_rows(n) >= n;
  if (is_mirrored) {
    std::ranges::reverse(conditions);
  }
  return conditions;
}

int williams_rows(int n) {
  return n % 2 == 0 ? n : 2 * n;
}

namespace {
// Over all rows, the step from one repetition to the next adds the pairs of one difference; unless
// a participant's own steps take every difference equally often, groups of rows take turns.
int groups_of(int n, int repetitions) {
  return (repetitions - 1) % (n - 1) == 0 ? 1 : n - 1;
}
}  // namespace

int williams_sequences(int n, int repetitions) {
  return williams_rows(n) * groups_of(n, repetitions);
}

std::vector<int> williams_sequence(int n, int repetitions, int sequence) {
  const int rows = williams_rows(n);
  const int group = sequence / rows;
  std::vector<int> row = williams_row(n, sequence % rows);
  std::vector<int> all = row;
  for (int repetition = 1; repetition < repetitions; ++repetition) {
    const int step = 1 + (group + repetition - 1) % (n - 1);  // never 0: no immediate repetition
    const int shift = row.back() + step + n - row.front();
    for (int& condition : row) {
      condition = (condition + shift) % n;
    }
    all.insert(all.end(), row.begin(), row.end());
  }
  return all;
}
}  // namespace tapstudy::protocols
