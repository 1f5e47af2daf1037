#include "protocols/constrained_order.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "protocols/ordering.hpp"
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
}  // namespace tapstudy::protocols
