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
OrderedStimulus condition(const Block& block, std::size_t index, int repetition) {
  if (!block.on_axis) {
    return {block.stimuli.at(index), repetition};
  }
  const std::size_t count = block.on_axis->values.size();
  return {block.stimuli.at(index / count),
          repetition,
          {{block.on_axis->axis, block.on_axis->values[index % count]}}};
}

std::vector<OrderedStimulus> listed(const Block& block) {
  std::vector<OrderedStimulus> all;
  for (int repetition = 1; repetition <= block.repetitions; ++repetition) {
    for (std::size_t i = 0; i < conditions(block); ++i) {
      all.push_back(condition(block, i, repetition));
    }
  }
  return all;
}

// Each run of as many participants as there are sequences takes every sequence once, in an order
// that the seed decides.
int sequence_of(int sequences, const Counterbalancing& counterbalancing) {
  std::vector<int> order(static_cast<std::size_t>(sequences));
  std::iota(order.begin(), order.end(), 0);
  const auto run = static_cast<std::uint64_t>(counterbalancing.order_index / sequences);
  core::Rng rng{core::derived_seed(counterbalancing.seed, core::Purpose::counterbalancing, run)};
  rng.shuffle(order);
  return order.at(static_cast<std::size_t>(counterbalancing.order_index % sequences));
}

std::vector<OrderedStimulus> williams(const Block& block,
                                      const Counterbalancing& counterbalancing) {
  const int n = static_cast<int>(conditions(block));
  const int sequence = sequence_of(williams_sequences(n, block.repetitions), counterbalancing);
  std::vector<OrderedStimulus> all;
  for (const int i : williams_sequence(n, block.repetitions, sequence)) {
    all.push_back(
        condition(block, static_cast<std::size_t>(i), 1 + static_cast<int>(all.size()) / n));
  }
  return all;
}

std::vector<OrderedStimulus> shuffled(const Block& block, core::Rng& rng) {
  std::vector<OrderedStimulus> all = listed(block);
  if (block.order == Order::shuffle) {
    rng.shuffle(all);
    // by how often the stimulus has been presented, whatever its place in the list was
    std::map<std::pair<std::string, AxisValues>, int> seen;
    for (OrderedStimulus& next : all) {
      next.repetition = ++seen[{next.stimulus, next.values}];
    }
    return all;
  }
  const std::size_t size = conditions(block);
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

std::vector<OrderedStimulus> constrained(const Block& block, core::Rng& rng) {
  ConstrainedOrders& orders = orders_of(block);
  const auto count = orders.count();
  if (!count || *count == 0.0) {
    throw core::InvalidInput{fmt::format(
        "block '{}': {}", block.name,
        count ? "no order satisfies its constraints"
              : "there are too many presentations to draw a constrained order (split the block)")};
  }
  std::vector<OrderedStimulus> all;
  std::map<std::size_t, int> seen;
  for (const std::size_t i : orders.draw(rng)) {
    all.push_back(condition(block, i, ++seen[i]));
  }
  return all;
}
}  // namespace

std::size_t conditions(const Block& block) {
  return block.stimuli.size() * (block.on_axis ? block.on_axis->values.size() : 1);
}

std::vector<OrderedStimulus> ordered_stimuli(const Block& block, core::Rng& rng,
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
