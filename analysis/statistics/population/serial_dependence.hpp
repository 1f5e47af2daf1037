#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>
namespace tapstudy::analysis {
// One participant's trials as they followed one another, as codes of answers.
struct AnswerSequence {
  std::vector<std::size_t> stimuli;    // what was presented
  std::vector<std::size_t> right;      // the answer that was right for it
  std::vector<std::size_t> responses;  // the answer that was given
};

// From this number of draws on, p is the share of them at least as far from `expected`, both + 1.
inline constexpr int fewest_draws_to_count = 999;

struct SerialEffect {
  double observed{};  // share of the trials that follow another
  double expected{};  // the mean of all permutations, in closed form
  double p{};    // two-sided; of few draws: by t of their spread, of as many degrees of freedom
  int trials{};  // that follow another
};
struct SerialDependence {
  SerialEffect repeated_answer;  // the answer is that of the trial before
  SerialEffect last_right;       // the answer would have been right for the trial before
};
// Each participant's answers are permuted among the trials of the same stimulus: that keeps what is
// confused with what, and breaks what one trial does to the next. Throws InvalidInput for sequences
// of different lengths, and draws below 1; no trials that follow another have p of 1.
SerialDependence serial_dependence(const std::vector<AnswerSequence>& participants, int draws,
                                   std::uint64_t seed, unsigned threads = 0);
}  // namespace tapstudy::analysis
