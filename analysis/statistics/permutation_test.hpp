#pragma once
#include <cstdint>
#include <vector>
namespace tapstudy::analysis {
// One participant's answers, trial by trial; equal numbers stand for equal names.
struct Answers {
  std::vector<int> stimuli;
  std::vector<int> responses;
};

// Is accuracy better than guessing? Each participant's responses are shuffled over that
// participant's own trials, which keeps everyone's habits of answering and makes no assumption of
// independence between participants: p = (1 + number of shuffles at least as accurate) /
// (shuffles + 1) (Hope 1968). The same seed gives the same p.
double permutation_p(const std::vector<Answers>& participants, int shuffles, std::uint64_t seed);
}  // namespace tapstudy::analysis
