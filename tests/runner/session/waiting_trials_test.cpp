#include "runner/session/waiting_trials.hpp"

#include "support/catch.hpp"
using namespace tapstudy;

namespace {
protocols::Schedule two_blocks() {
  protocols::Schedule schedule;
  for (int number = 1; number <= 6; ++number) {
    protocols::PlannedTrial trial;
    trial.number = number;
    trial.block = number <= 4 ? "first" : "second";
    schedule.push_back(trial);
  }
  return schedule;
}
std::vector<int> numbers_of(const std::deque<protocols::PlannedTrial>& trials) {
  std::vector<int> numbers;
  for (const protocols::PlannedTrial& trial : trials) {
    numbers.push_back(trial.number);
  }
  return numbers;
}
}  // namespace

TEST_CASE("a session that is resumed presents requeued trials where it would have gone on to",
          "[runner][session]") {
  const protocols::Schedule schedule = two_blocks();
  auto waiting = runner::waiting_trials(schedule, {}, {});
  for (const int number : {1, 2}) {
    const protocols::PlannedTrial trial = waiting.front();
    REQUIRE(trial.number == number);
    waiting.pop_front();
    runner::put_at_end_of_block(trial, waiting);
  }
  CHECK(numbers_of(waiting) == std::vector{3, 4, 1, 2, 5, 6});
  CHECK(numbers_of(runner::waiting_trials(schedule, {}, {1, 2})) == numbers_of(waiting));
  // requeued once more, in the other order; what is done is not presented
  CHECK(numbers_of(runner::waiting_trials(schedule, {3, 4}, {2, 1})) == std::vector{2, 1, 5, 6});
  CHECK(numbers_of(runner::waiting_trials(schedule, {1, 2, 3}, {2, 4})) == std::vector{4, 5, 6});
  CHECK(numbers_of(runner::waiting_trials(schedule, {}, {6, 5})) == std::vector{1, 2, 3, 4, 6, 5});
}
