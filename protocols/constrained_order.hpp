#pragma once
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/rng.hpp"
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
}  // namespace tapstudy::protocols
