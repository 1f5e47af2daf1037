#pragma once
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/random/rng.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::protocols {
// All random orders of a block, shuffled whole or within its repetitions, that satisfy its
// constraints: how many there are, and one of them, each equally likely. Drawn place by place, a
// stimulus as likely as it has completions; these are counted once for each state, in which stimuli
// differ only by how often they are still to come.
class ConstrainedOrders {
 public:
  explicit ConstrainedOrders(const Block& block);
  // nullopt: there are too many states to be counted.
  std::optional<double> count();
  // By the place of each stimulus in the list. There must be some.
  std::vector<std::size_t> draw(core::Rng& rng);

 private:
  struct State {
    std::vector<int> left;            // of each stimulus
    std::vector<std::size_t> recent;  // the latest presentations, oldest first
    int run{0};                       // of the latest
  };
  bool may_come(const State& state, std::size_t stimulus) const;
  State after(State state, std::size_t stimulus) const;
  static std::string key_of(const State& state);
  double completions(const State& state);
  // Of each stimulus: in how many orders it comes next.
  std::vector<double> weights_of(const State& state);

  State begin_;
  OrderConstraints constraints_;
  bool is_within_repetition_;
  std::unordered_map<std::string, double> counted_;
  bool is_too_large_{false};
};

// How many conditions a block orders: its stimuli, or those at each of its values.
std::size_t conditions(const Block& block);
struct OrderedCondition {
  std::size_t condition{};  // from 0
  int repetition{};         // counts the presentations of this condition, from 1
};
// Of a condition; its values where the block names values of an axis.
std::size_t stimulus_of(const Block& block, std::size_t condition);
AxisValues values_of(const Block& block, std::size_t condition);
// Which participants get which of the balanced sequences.
struct Counterbalancing {
  int order_index{};     // from 0
  std::uint64_t seed{};  // of the study
};
// The sequence, from 0, that this participant gets: each run of as many participants as there are
// sequences takes every sequence once, in an order that the seed decides.
int balanced_sequence(int sequences, const Counterbalancing& counterbalancing);
// A block's conditions in the specified order, each presented `repetitions` times. Where
// constraints are set, all random orders that satisfy them are equally likely. Throws InvalidInput
// if there are none, or more than can be counted.
std::vector<OrderedCondition> ordered_conditions(const Block& block, core::Rng& rng,
                                                 const Counterbalancing& counterbalancing);
std::vector<OrderedCondition> ordered_conditions(const Block& block, const Draw& draw);

// Row `row` of a balanced Latin square of n conditions (Williams 1949, by the construction of
// Bradley 1958): every condition follows every other equally often. n rows if n is even, otherwise
// 2 n.
std::vector<int> williams_row(int n, int row);
int williams_rows(int n);

// The whole of a participant's presentations: in each repetition a row of such a square, joined so
// that over williams_sequences(n, repetitions) participants every condition follows every other
// equally often, across repetitions too, and none follows itself; over williams_rows(n) sequences
// that begin at a multiple of it, every condition is at every place of a repetition equally often.
// n > 1.
std::vector<int> williams_sequence(int n, int repetitions, int sequence);
int williams_sequences(int n, int repetitions);
}  // namespace tapstudy::protocols
