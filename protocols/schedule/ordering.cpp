#include "protocols/schedule/ordering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <span>

#include "core/error.hpp"
namespace tapstudy::protocols {
namespace {
constexpr std::size_t max_states = 1'000'000;
constexpr int max_presentations = 2'000;
}  // namespace

ConstrainedOrders::ConstrainedOrders(const Block& block)
    : begin_{std::vector<int>(conditions(block), block.repetitions), {}, 0},
      constraints_{block.constraints},
      is_within_repetition_{block.order == Order::shuffle_within_repetition},
      is_too_large_{static_cast<int>(conditions(block)) * block.repetitions > max_presentations} {}

bool ConstrainedOrders::may_come(const State& state, std::size_t stimulus) const {
  if (state.left[stimulus] == 0 ||
      (is_within_repetition_ && state.left[stimulus] < std::ranges::max(state.left))) {
    return false;  // or what comes less often than another would come twice in a repetition
  }
  if (constraints_.min_distance > 1) {
    return std::ranges::find(state.recent, stimulus) == state.recent.end();
  }
  const bool is_again = !state.recent.empty() && state.recent.back() == stimulus;
  return !is_again || constraints_.max_run == 0 || state.run < constraints_.max_run;
}

ConstrainedOrders::State ConstrainedOrders::after(State state, std::size_t stimulus) const {
  --state.left[stimulus];
  state.run = !state.recent.empty() && state.recent.back() == stimulus ? state.run + 1 : 1;
  state.recent.push_back(stimulus);
  const auto remembered = static_cast<std::size_t>(std::max(1, constraints_.min_distance - 1));
  if (state.recent.size() > remembered) {
    state.recent.erase(state.recent.begin());
  }
  return state;
}

std::string ConstrainedOrders::key_of(const State& state) {
  std::vector<int> others;
  for (std::size_t i = 0; i < state.left.size(); ++i) {
    if (std::ranges::find(state.recent, i) == state.recent.end()) {
      others.push_back(state.left[i]);
    }
  }
  std::ranges::sort(others);
  std::string key;
  const auto add = [&](int number) {  // at most max_presentations: two bytes
    key += static_cast<char>(number & 0xff);
    key += static_cast<char>(number >> 8);
  };
  add(state.run);
  for (const std::size_t stimulus : state.recent) {
    add(state.left[stimulus]);
  }
  std::ranges::for_each(others, add);
  return key;
}

double ConstrainedOrders::completions(const State& state) {
  if (std::ranges::all_of(state.left, [](int left) { return left == 0; })) {
    return 1.0;
  }
  const std::string key = key_of(state);
  if (const auto known = counted_.find(key); known != counted_.end()) {
    return known->second;
  }
  is_too_large_ = is_too_large_ || counted_.size() >= max_states;
  if (is_too_large_) {
    return 0.0;
  }
  const std::vector<double> weights = weights_of(state);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  counted_[key] = sum;
  return sum;
}

std::vector<double> ConstrainedOrders::weights_of(const State& state) {
  std::vector<double> weights(state.left.size(), 0.0);
  std::map<int, double> of_others;  // alike are those that are not recent and as often to come
  for (std::size_t i = 0; i < state.left.size(); ++i) {
    if (!may_come(state, i)) {
      continue;
    }
    const bool is_recent = std::ranges::find(state.recent, i) != state.recent.end();
    const auto alike = of_others.find(state.left[i]);
    const bool is_known = !is_recent && alike != of_others.end();
    weights[i] = is_known ? alike->second : completions(after(state, i));
    if (!is_recent) {
      of_others[state.left[i]] = weights[i];
    }
  }
  return weights;
}

std::optional<double> ConstrainedOrders::count() {
  const double orders = completions(begin_);
  return is_too_large_ || !std::isfinite(orders) ? std::nullopt : std::optional{orders};
}

std::vector<std::size_t> ConstrainedOrders::draw(core::Rng& rng) {
  std::vector<std::size_t> order;
  State state = begin_;
  const int presentations = std::accumulate(begin_.left.begin(), begin_.left.end(), 0);
  while (std::ssize(order) < presentations) {
    const std::vector<double> weights = weights_of(state);
    double left = rng.uniform() * std::accumulate(weights.begin(), weights.end(), 0.0);
    std::size_t next = state.left.size();
    for (std::size_t i = 0; i < weights.size() && (next == weights.size() || left >= 0.0); ++i) {
      if (weights[i] > 0.0) {
        next = i;  // the last that may come, where rounding leaves a rest
        left -= weights[i];
      }
    }
    order.push_back(next);
    state = after(state, next);
  }
  return order;
}

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
