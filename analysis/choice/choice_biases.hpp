#pragma once
#include <optional>
#include <string>
#include <vector>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
// Choices by what has nothing to do with the stimuli. All trials count: where labels were drawn
// anew for each, the choices of one participant are as independent of them as anybody's.
struct ChoiceBiases {
  std::vector<std::string> labels;  // by position
  std::vector<int> chosen;          // how often each was
  std::optional<double> labels_p;   // all equally likely, exact multinomial; unset: too many
                                    // outcomes, or no answers
  Proportion first_visited;         // chosen what was visited first, of trials where all were
  Proportion last_visited;          // ... and last
  double chance{};                  // of either
};

// Throws InvalidInput if trials of the block differ in their number of alternatives.
ChoiceBiases choice_biases(const BlockRows& rows);

// counts[i][j]: how often stimulus j was visited directly after stimulus i, in all trials.
std::vector<std::vector<std::int64_t>> transitions(const std::vector<Item>& stimuli,
                                                   const BlockRows& rows);

// The two-sided exact probability of a binomial count: of all outcomes no likelier than it
// (Sterne 1954). trials > 0, chance in (0, 1).
double binomial_two_sided_p(const Proportion& observed, double chance);
}  // namespace tapstudy::analysis
