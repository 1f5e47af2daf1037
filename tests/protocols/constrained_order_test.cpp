// Constrained orders against the enumeration of all orders.
#include "protocols/constrained_order.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "support/catch.hpp"
using namespace tapstudy;
using Order = std::vector<std::size_t>;

namespace {
struct Case {
  std::size_t stimuli{};
  int repetitions{};
  protocols::OrderConstraints constraints{};
  bool is_within_repetition{};
};

int longest_run(const Order& order) {
  int longest = 0;
  int run = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    run = i > 0 && order[i] == order[i - 1] ? run + 1 : 1;
    longest = std::max(longest, run);
  }
  return longest;
}

std::size_t least_distance(const Order& order) {
  std::size_t least = order.size() + 1;
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      least = order[i] == order[j] ? std::min(least, j - i) : least;
    }
  }
  return least;
}

bool has_whole_repetitions(const Order& order, std::size_t stimuli) {
  for (std::size_t from = 0; from < order.size(); from += stimuli) {
    for (std::size_t stimulus = 0; stimulus < stimuli; ++stimulus) {
      const auto begin = order.begin() + static_cast<std::ptrdiff_t>(from);
      if (std::count(begin, begin + static_cast<std::ptrdiff_t>(stimuli), stimulus) != 1) {
        return false;
      }
    }
  }
  return true;
}

std::map<Order, int> enumerated(const Case& of) {
  Order order;
  for (std::size_t stimulus = 0; stimulus < of.stimuli; ++stimulus) {
    order.insert(order.end(), static_cast<std::size_t>(of.repetitions), stimulus);
  }
  std::map<Order, int> all;
  const auto& [max_run, min_distance] = of.constraints;
  do {
    if ((max_run == 0 || longest_run(order) <= max_run) &&
        least_distance(order) >= static_cast<std::size_t>(std::max(1, min_distance)) &&
        (!of.is_within_repetition || has_whole_repetitions(order, of.stimuli))) {
      all[order] = 0;
    }
  } while (std::ranges::next_permutation(order).found);
  return all;
}
}  // namespace

TEST_CASE("constrained orders are those of the enumeration, each drawn equally often",
          "[protocols][schedule]") {
  const Case of =
      GENERATE(Case{3, 3, {1, 1}, false}, Case{2, 4, {2, 1}, false}, Case{3, 2, {2, 1}, false},
               Case{4, 2, {0, 3}, false}, Case{3, 3, {0, 2}, true}, Case{4, 2, {0, 3}, true});
  CAPTURE(of.stimuli, of.repetitions, of.constraints.max_run, of.constraints.min_distance,
          of.is_within_repetition);
  protocols::Block block;
  for (std::size_t i = 0; i < of.stimuli; ++i) {
    block.stimuli.push_back(std::to_string(i));
  }
  block.repetitions = of.repetitions;
  block.constraints = of.constraints;
  block.order = of.is_within_repetition ? protocols::Order::shuffle_within_repetition
                                        : protocols::Order::shuffle;
  auto times = enumerated(of);
  REQUIRE(times.size() > 1);
  protocols::ConstrainedOrders orders{block};
  CHECK(orders.count() == static_cast<double>(times.size()));
  core::Rng rng{7};
  constexpr int mean = 100;
  for (std::size_t i = 0; i < mean * times.size(); ++i) {
    const auto drawn = times.find(orders.draw(rng));
    REQUIRE(drawn != times.end());
    ++drawn->second;
  }
  double chi_squared = 0.0;
  for (const auto& [order, count] : times) {
    chi_squared += std::pow(count - mean, 2.0) / mean;
  }
  const auto degrees_of_freedom = static_cast<double>(times.size() - 1);
  CHECK(chi_squared < degrees_of_freedom + 5.0 * std::sqrt(2.0 * degrees_of_freedom) + 10.0);
}

// Too many orders to enumerate, of which none immediately repeats: 8 stimuli ten times each.
TEST_CASE("ordinary designs are drawn however many orders they have", "[protocols][order]") {
  protocols::Block block;
  for (std::size_t i = 0; i < 8; ++i) {
    block.stimuli.push_back(std::to_string(i));
  }
  block.repetitions = 10;
  block.constraints.max_run = 1;
  protocols::ConstrainedOrders orders{block};
  REQUIRE(orders.count());
  core::Rng rng{3};
  for (int i = 0; i < 20; ++i) {
    const Order order = orders.draw(rng);
    CHECK(longest_run(order) == 1);
    for (std::size_t stimulus = 0; stimulus < 8; ++stimulus) {
      CHECK(std::ranges::count(order, stimulus) == 10);
    }
  }
}
