#pragma once
#include <cstddef>
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
struct TimedAnswer {
  double time_s{};
  bool is_right{};
};
using TimedAnswers = std::vector<TimedAnswer>;  // one participant's

// A conditional accuracy function: each participant's answers in order of their times are cut into
// as many parts of equal size as bins (sizes differ by one at most); times and shares right of a
// part are averaged over participants (Vincent 1912; Thomas 1974).
struct ConditionalAccuracyBin {
  double mean_time_s{};
  double share_right{};
};
// Participants with fewer answers than bins are left out; empty if none is left. Throws
// InvalidInput for bins below 1 and times that are not finite.
std::vector<ConditionalAccuracyBin> conditional_accuracy(
    const std::vector<TimedAnswers>& participants, std::size_t bins);

// Speed and accuracy of a participant in a condition, taken together.
struct SpeedAndAccuracy {
  double share_right{};
  double mean_time_s{};
};
// The balanced integration score, z(share right) - z(mean time), standardised over all entries with
// the standard deviation of n (Liesefeld & Janczyk 2019). All entries 0 in a part that does not
// vary. Empty for fewer than two entries.
std::vector<double> balanced_integration_scores(const std::vector<SpeedAndAccuracy>& entries);
}  // namespace tapstudy::analysis
