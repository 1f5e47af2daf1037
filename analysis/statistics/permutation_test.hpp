#pragma once
#include <cstdint>
#include <vector>
namespace tapstudy::analysis {
// One participant's answers, trial by trial, as integer codes.
struct Answers {
  std::vector<int> stimuli;
  std::vector<int> responses;
};

// Permutation test of accuracy against chance. Each participant's responses are shuffled over that
// participant's own trials, which preserves individual response biases and makes no assumption of
// independence between participants: p = (1 + number of shuffles at least as accurate) /
// (shuffles + 1) (Hope 1968). The same seed gives the same p.
double permutation_p(const std::vector<Answers>& participants, int shuffles, std::uint64_t seed);
}  // namespace tapstudy::analysis
