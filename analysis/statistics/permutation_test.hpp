#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "analysis/statistics/count_table.hpp"
namespace tapstudy::analysis {
// One participant's answers, trial by trial, as integer codes.
struct Answers {
  std::vector<int> stimuli;
  std::vector<int> responses;
};

// The stimuli that a participant (by place in the list) would have been presented, trial by trial,
// in another draw of the study's own randomisation. All participants of one draw belong together:
// counterbalancing deals its orders out among them. Called from several threads at once.
using Redraw = std::function<std::vector<int>(std::size_t participant, std::uint64_t draw)>;

struct PermutationResult {
  double p{};     // (1 + draws at least as accurate) / (draws + 1) (Hope 1968)
  int as_good{};  // draws at least as accurate; if none, p is only known to be no larger
  int draws{};
};

// Randomisation test of accuracy against chance (Fisher 1935; Edgington 1980): responses stay as
// they were, stimuli are drawn again by the very randomisation that the study used, which is what
// makes it valid. It preserves individual response biases and makes no assumption of independence
// between participants. An answer is right if its code is that of the stimulus. The same seed gives
// the same p, on any number of threads.
PermutationResult permutation_test(const std::vector<Answers>& participants, const Redraw& redraw,
                                   int draws, std::uint64_t seed);

// is_right[stimulus][response]; codes are places in it.
using RightAnswers = std::vector<std::vector<bool>>;
// The same for several notions of right at once, on the same draws.
std::vector<PermutationResult> permutation_tests(const std::vector<Answers>& participants,
                                                 const Redraw& redraw,
                                                 const std::vector<RightAnswers>& notions,
                                                 int draws, std::uint64_t seed);

// The same where the study's own orders are too many to draw: each participant's responses (counts
// of stimuli by responses) are shuffled over the trials.
std::vector<PermutationResult> shuffle_tests(const std::vector<CountTable>& participants,
                                             const std::vector<RightAnswers>& notions, int draws,
                                             std::uint64_t seed);
}  // namespace tapstudy::analysis
