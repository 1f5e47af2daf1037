// progress_bench: how long a session takes to know how far it is, a trial, where there are many of
// them: before each of all trials the progress and the time left, after it that it is done. Prints
// nanoseconds a trial and the ratio to the first: 1 where the whole is linear in the number of
// trials, as many times more as there are more trials where it is quadratic.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "runner/session/engine/remaining_trials.hpp"
using namespace tapstudy;

namespace {
double seconds_a_trial(int trials, const protocols::Protocol& protocol) {
  protocols::Schedule schedule(static_cast<std::size_t>(trials));
  for (int i = 0; i < trials; ++i) {
    protocols::PlannedTrial& trial = schedule[static_cast<std::size_t>(i)];
    trial.number = i + 1;
    trial.block = protocol.blocks[static_cast<std::size_t>(i % 2)].name;
  }
  const auto begin = std::chrono::steady_clock::now();
  runner::SessionProgress progress{schedule, {}, protocol};
  double sum = 0.0;
  for (const protocols::PlannedTrial& trial : schedule) {
    sum += progress.before(trial).done + progress.left_s(10.0, 5).value_or(0.0);
    progress.note_done(trial);
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  return sum > 0.0 ? taken.count() / trials : 0.0;
}
}  // namespace

int main() {
  protocols::Protocol protocol;
  for (const char* const name : {"practice", "test"}) {
    protocol.blocks.emplace_back().name = name;
  }
  protocol.blocks.front().is_practice = true;
  double first = 0.0;
  for (const int trials : {1'000, 10'000, 100'000}) {
    std::vector<double> taken;
    for (int run = 0; run < 5; ++run) {
      taken.push_back(seconds_a_trial(trials, protocol));
    }
    const double median = (std::ranges::nth_element(taken, taken.begin() + 2), taken[2]);
    first = first == 0.0 ? median : first;
    fmt::print("{:>7} trials: {:6.1f} ns a trial, {:.2f} times that of the first\n", trials,
               1e9 * median, median / first);
  }
}
